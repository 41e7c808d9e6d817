#include "scenario/hidden_path.hpp"

#include <algorithm>
#include <csignal>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace monograin {
namespace {

namespace fs = std::filesystem;

constexpr int k_attempts = 3;

struct Hidden {
  fs::path path;
  fs::path shown;
};

/// All hidden paths of the process. Never destroyed, because threads may outlive static objects.
struct Registry {
  std::recursive_mutex ends;  ///< held while the process must not end
  std::mutex mutex;
  std::vector<Hidden> paths;
};

Registry& registry() {
  static auto* const registry = new Registry;
  return *registry;
}

bool waits_for_signals = false;
sigset_t signals_at_start;

/// Signals that a user sends to end the process, without those that it was started to ignore.
sigset_t ending_signals() noexcept {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action = {};
    if (sigaction(signal, nullptr, &action) == 0 && action.sa_handler != SIG_IGN) sigaddset(&signals, signal);
  }
  return signals;
}

/// Waits for a signal, removes the hidden paths, and ends the process by that signal.
void wait_for_end(const sigset_t& signals) {
  int signal = 0;
  while (sigwait(&signals, &signal) != 0) continue;
  // A thread that fails because its files are gone blocks here when it gives up its own hidden path, and says nothing.
  const std::scoped_lock lock(registry().ends, registry().mutex);
  for (const Hidden& hidden : registry().paths) {
    for (int k = 0; k < k_attempts; ++k) {  // another program may still write there
      std::error_code failure;
      fs::remove_all(hidden.path, failure);
      if (!failure) break;
    }
  }
  std::signal(signal, SIG_DFL);
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
  std::raise(signal);
}

}  // namespace

HiddenPath::HiddenPath(fs::path path, fs::path shown) : path_(std::move(path)) {
  const std::scoped_lock lock(registry().mutex);
  registry().paths.push_back({path_, std::move(shown)});
}

HiddenPath::HiddenPath(HiddenPath&& other) noexcept : path_(std::exchange(other.path_, {})) {}

HiddenPath& HiddenPath::operator=(HiddenPath&& other) noexcept {
  remove();
  path_ = std::exchange(other.path_, {});
  return *this;
}

HiddenPath::~HiddenPath() { remove(); }

void HiddenPath::remove() noexcept {
  if (path_.empty()) return;
  std::error_code ignored;  // what cannot be removed stays hidden
  fs::remove_all(path_, ignored);
  release();
}

void HiddenPath::release() noexcept {
  const std::scoped_lock lock(registry().mutex);
  std::erase_if(registry().paths, [&](const Hidden& hidden) { return hidden.path == path_; });
  path_.clear();
}

fs::path shown_path(const fs::path& path) {
  const std::scoped_lock lock(registry().mutex);
  const auto& paths = registry().paths;
  for (auto hidden = paths.rbegin(); hidden != paths.rend(); ++hidden) {  // the innermost first
    const auto [end, rest] = std::ranges::mismatch(hidden->path, path);
    if (end != hidden->path.end()) continue;
    fs::path shown = hidden->shown;
    for (auto part = rest; part != path.end(); ++part) shown /= *part;
    return shown;
  }
  return path;
}

void remove_hidden_paths_at_signals() noexcept {
  const sigset_t signals = ending_signals();
  registry();
  pthread_sigmask(SIG_BLOCK, &signals, &signals_at_start);
  try {
    std::thread(wait_for_end, signals).detach();
    waits_for_signals = true;
  } catch (const std::system_error&) {  // no thread to be had: signals end the process at once
    pthread_sigmask(SIG_SETMASK, &signals_at_start, nullptr);
  }
}

std::unique_lock<std::recursive_mutex> hold_signals() { return std::unique_lock(registry().ends); }

void restore_signals() noexcept {
  if (waits_for_signals) pthread_sigmask(SIG_SETMASK, &signals_at_start, nullptr);
}

}  // namespace monograin
