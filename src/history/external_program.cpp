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

namespace monograin {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds k_interval{100};

std::string cannot_be_started(const fs::path& program, int error) {
  return fmt::format("{} cannot be started: {}", program.string(), std::strerror(error));
}

/// Turns a new process into a program, or sends the reason why not. Calls only what is safe after fork().
[[noreturn]] void become(const fs::path& program, const std::vector<char*>& argv, const fs::path& folder,
                         const fs::path& log, int failure) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  const bool is_ready = chdir(folder.c_str()) == 0 && dup2(open("/dev/null", O_RDONLY), STDIN_FILENO) == STDIN_FILENO &&
                        dup2(open(log.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0644), STDOUT_FILENO) == STDOUT_FILENO &&
                        dup2(STDOUT_FILENO, STDERR_FILENO) == STDERR_FILENO;
  if (is_ready) execv(program.c_str(), argv.data());
  const int error = errno;
  [[maybe_unused]] const ssize_t sent = write(failure, &error, sizeof error);
  _exit(EXIT_FAILURE);
}

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
  const pid_t child = fork();
  if (child == 0) become(program, argv, folder, log, ends[1]);
  const int fork_error = errno;
  close(ends[1]);
  int failure = child < 0 ? fork_error : 0;
  if (child > 0 && read(ends[0], &failure, sizeof failure) != sizeof failure) failure = 0;
  close(ends[0]);
  int status = 0;
  while (child > 0) {
    const pid_t ended = waitpid(child, &status, meanwhile ? WNOHANG : 0);
    if (ended == child || (ended < 0 && errno != EINTR)) break;
    if (!meanwhile) continue;
    meanwhile();
    std::this_thread::sleep_for(k_interval);
  }
  if (failure != 0) throw std::runtime_error(cannot_be_started(program, failure));
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

}  // namespace monograin
