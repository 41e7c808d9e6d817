// What libFuzzer calls with the bytes that it makes up.

#include <cstddef>
#include <cstdint>

#include "fuzz/readers.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  monograin::read_any({reinterpret_cast<const char*>(data), size});
  return 0;
}
