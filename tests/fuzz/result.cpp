// A result file without its seal, which is read in a process of its own.
#include <unistd.h>

#include <fstream>

#include "cradle/tests/fuzz/fuzz.hpp"
#include "cradle/tools/result/reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cradle;
  static const std::string path = "/tmp/cradle-fuzz-" + std::to_string(::getpid()) + ".h5";
  return fuzz::refused_or_read(data, size, [](const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
    tools::read_result(path);
  });
}
