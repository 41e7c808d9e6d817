#include "history/external_program.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <thread>

#include <fmt/format.h>

#include "scenario/hidden_path.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds k_interval{100};

std::string cannot_be_started(const fs::path& program, int error) {
  return fmt::format("{} cannot be started: {}", program.string(), std::strerror(error));
}

/// Puts a file in the place of a standard stream.
bool redirect(int stream, const char* file, int flags) {
  constexpr mode_t k_mode = 0644;
  const int opened = open(file, flags | O_CLOEXEC, k_mode);
  return opened >= 0 && dup2(opened, stream) == stream;
}

/// Turns a new process into a program, or sends the reason why not. Calls only what is safe after fork().
[[noreturn]] void become(const fs::path& program, const std::vector<char*>& argv, const fs::path& folder,
                         const fs::path& log, pid_t parent, int failure) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(EXIT_FAILURE);  // the parent has ended before
  restore_signals();
  if (chdir(folder.c_str()) == 0 && redirect(STDIN_FILENO, "/dev/null", O_RDONLY) &&
      redirect(STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_EXCL) &&
      dup2(STDOUT_FILENO, STDERR_FILENO) == STDERR_FILENO) {
    execv(program.c_str(), argv.data());
  }
  const int error = errno;
  [[maybe_unused]] const ssize_t sent = write(failure, &error, sizeof error);
  _exit(EXIT_FAILURE);
}

/// A process of which this one waits for the end. The destructor ends it, if it goes on.
class Child {
 public:
  explicit Child(pid_t process) : process_(process) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (process_ <= 0) return;
    kill(process_, SIGTERM);
    while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) continue;
  }

  /// Status of the ended process; none while it goes on.
  /// @param waits  false: returns at once
  std::optional<int> status(bool waits) {
    int status = 0;
    const pid_t ended = waitpid(process_, &status, waits ? 0 : WNOHANG);
    if (ended == 0 || (ended < 0 && errno == EINTR)) return std::nullopt;
    process_ = 0;
    if (ended < 0) {
      throw std::runtime_error(
          "cannot tell how a program that was started has ended: this process ignores SIGCHLD, or waits for it "
          "elsewhere");
    }
    return status;
  }

 private:
  pid_t process_;
};

}  // namespace

std::optional<fs::path> find_program(std::string_view name) {
  const char* const variable = std::getenv("PATH");
  std::string_view folders = variable ? variable : "/usr/local/bin:/usr/bin:/bin";
  for (;;) {
    const std::size_t colon = folders.find(':');
    const fs::path candidate = fs::path(folders.substr(0, colon)) / name;
    std::error_code ignored;
    if (fs::is_regular_file(candidate, ignored) && access(candidate.c_str(), X_OK) == 0) return fs::absolute(candidate);
    if (colon == std::string_view::npos) return std::nullopt;
    folders.remove_prefix(colon + 1);
  }
}

int run_program(const fs::path& program, std::vector<std::string> words, const fs::path& folder, const fs::path& log,
                const std::function<void()>& meanwhile) {
  words.insert(words.begin(), program.string());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  // The child sends the reason if it cannot start the program; else the end of the pipe closes.
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error(cannot_be_started(program, errno));
  const pid_t parent = getpid();
  const pid_t process = fork();
  if (process == 0) become(program, argv, folder, log, parent, ends[1]);
  int failure = process < 0 ? errno : 0;
  close(ends[1]);
  Child child(process);
  int reason = 0;
  if (process > 0 && read(ends[0], &reason, sizeof reason) == sizeof reason) failure = reason;
  close(ends[0]);
  if (failure != 0) throw std::runtime_error(cannot_be_started(program, failure));
  for (;;) {
    if (const auto status = child.status(!meanwhile)) {
      return WIFEXITED(*status) ? WEXITSTATUS(*status) : -WTERMSIG(*status);
    }
    if (!meanwhile) continue;
    meanwhile();
    std::this_thread::sleep_for(k_interval);
  }
}

}  // namespace monograin
