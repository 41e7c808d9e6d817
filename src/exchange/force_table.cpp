#include "exchange/force_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <stdexcept>

namespace monograin {
namespace {

std::size_t index_of(const Motion& motion, const std::optional<std::string>& name) {
  for (std::size_t i = 0; i < motion.classes.size(); ++i) {
    if (name && motion.classes[i] != *name) continue;
    if (motion.moves(i)) return i;
    if (name) throw std::invalid_argument(fmt::format("the walls of contact class '{}' do not move", *name));
  }
  if (!name) throw std::invalid_argument("no wall moves");
  throw std::invalid_argument(
      fmt::format("there is no contact class '{}'; the scene has {}", *name, fmt::join(motion.classes, ", ")));
}

}  // namespace

Table force_table(const Motion& motion, const std::optional<std::string>& contact_class) {
  const std::size_t index = index_of(motion, contact_class);
  const std::string& name = motion.classes[index];
  Table table({{"branch"}, {name + ".displacement", "m"}, {name + ".force", "N"}});
  table.header = motion.header;
  const ContactInstant* last = nullptr;
  double direction = 0.0;
  double branch = 1.0;
  const auto append = [&](const ContactInstant& contact) {
    table.append(std::array{branch, contact.displacement, contact.force});
  };
  for (const MotionInstant& instant : motion.instants) {
    const ContactInstant& contact = instant.contacts[index];
    if (last == nullptr) append(contact);
    const double change = last == nullptr ? 0.0 : contact.displacement - last->displacement;
    if (change * direction < 0.0) {
      ++branch;
      append(*last);
    }
    if (change != 0.0) {
      direction = change;
      append(contact);
    }
    last = &contact;
  }
  return table;
}

}  // namespace monograin
