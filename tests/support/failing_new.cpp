// Loaded before a program: makes one allocation of its main() fail, the one with the number
// MONOGRAIN_FAILING_ALLOCATION. If there are fewer allocations, a line on stderr says so.

#include <dlfcn.h>

#include <atomic>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <new>

namespace {

std::atomic<long> allocations_left{0};  // allocations until one fails; 0: none fails
int (*program_main)(int, char**, char**) = nullptr;

bool fails_now() {
  const long left = allocations_left.load();
  if (left > 0) allocations_left.store(left - 1);
  return left == 1;
}

int main_from_here(int argc, char** argv, char** environment) {
  if (const char* count = std::getenv("MONOGRAIN_FAILING_ALLOCATION")) allocations_left = std::atol(count);
  const int code = program_main(argc, argv, environment);
  if (allocations_left.exchange(0) > 0) std::fputs("no allocation has failed\n", stderr);
  return code;
}

}  // namespace

void* operator new(std::size_t size) {
  if (!fails_now()) {
    if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  }
  if (const std::new_handler handler = std::get_new_handler()) handler();
  throw std::bad_alloc();
}

void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

/// Replaces the function with which the C library calls main().
extern "C" int __libc_start_main(int (*main_function)(int, char**, char**), int argc, char** argv, void (*init)(),
                                 void (*fini)(), void (*unload)(), void* stack_end) {
  program_main = main_function;
  const auto start = reinterpret_cast<decltype(&__libc_start_main)>(dlsym(RTLD_NEXT, "__libc_start_main"));
  return start(main_from_here, argc, argv, init, fini, unload, stack_end);
}
