/// Contacts that follow another one: they do no work, and do not act back. The functions of a law are listed in
/// contacts/independent.hpp.
#pragma once

#include <span>
#include <vector>

#include "system/walls.hpp"

namespace monograin::contacts {

/// Followers among the contact classes; all have the same leader, the first contact that follows none. A law must leave
/// one.
template <class Law>
class Followers {
 public:
  Followers(const Law& law, std::span<const ContactClass> classes) {
    if constexpr (k_exist) {
      for (const ContactClass& walls : classes) follows_.push_back(law.follows(walls));
      while (leader_ < follows_.size() && follows_[leader_]) ++leader_;
    }
  }

  [[nodiscard]] bool follows(std::size_t i) const noexcept { return k_exist && follows_[i]; }
  [[nodiscard]] std::size_t leader() const noexcept { return leader_; }
  /// Index of the contact itself; for a follower, of its leader.
  [[nodiscard]] std::size_t leading(std::size_t i) const noexcept { return follows(i) ? leader_ : i; }
  /// Classes of the contacts that follow this one.
  [[nodiscard]] std::vector<int> of(std::size_t i) const {
    std::vector<int> list;
    for (std::size_t k = 0; i == leader_ && k < follows_.size(); ++k) {
      if (follows_[k]) list.push_back(static_cast<int>(k));
    }
    return list;
  }

 private:
  static constexpr bool k_exist = requires(const Law& law, const ContactClass& walls) { law.follows(walls); };

  std::vector<bool> follows_;
  std::size_t leader_ = 0;
};

}  // namespace monograin::contacts
