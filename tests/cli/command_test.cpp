#include "cli/command_test.hpp"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <thread>

namespace monograin {

namespace fs = std::filesystem;

Outcome CommandTest::monograin(const std::string& arguments) const { return shell("monograin " + arguments); }

Outcome CommandTest::shell(const std::string& script) const {
  const std::string command = "cd '" + folder().string() +
                              "' && M='" MONOGRAIN_PROGRAM "' && monograin() { \"$M\" \"$@\"; }\n(" + script +
                              "\n) > stdout.txt 2> stderr.txt < /dev/null";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text("stdout.txt"), text("stderr.txt")};
}

bool CommandTest::start_and_kill(const std::vector<std::string>& arguments, std::chrono::microseconds delay,
                                 int signal) const {
  std::vector<std::string> words{MONOGRAIN_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    if (chdir(folder().c_str()) != 0 || freopen("/dev/null", "w", stderr) == nullptr) _exit(9);
    execv(MONOGRAIN_PROGRAM, argv.data());
    _exit(9);
  }
  std::this_thread::sleep_for(delay);
  kill(child, signal);
  int status = 0;
  waitpid(child, &status, 0);
  return WIFSIGNALED(status);
}

std::vector<std::string> CommandTest::files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder())) {
    const std::string name = fs::relative(entry.path(), folder()).string();
    if (name != "stdout.txt" && name != "stderr.txt") names.push_back(name);
  }
  return names;
}

}  // namespace monograin
