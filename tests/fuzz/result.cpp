// Results as bytes, with any names, types and shapes: every result that can be written as a file can be read from it.
// The seal, which a fuzzer does not guess, protects HDF5, which crashes on damaged files.
#include <unistd.h>

#include <fstream>

#include "cradle/tests/fuzz/fuzz.hpp"
#include "cradle/tools/result/reader.hpp"
#include "cradle/tools/result/writer.hpp"
#include "cradle/tools/support/bytes.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cradle::tools;
  static const std::string path = "/tmp/cradle-fuzz-" + std::to_string(::getpid()) + ".h5";
  return cradle::fuzz::refused_or_read(data, size, [](const std::string& bytes) {
    auto [attributes, groups] = from_bytes<std::pair<std::vector<Attribute>, std::vector<Group>>>(bytes);
    std::ofstream(path, std::ios::binary) << file_image({std::move(attributes), std::move(groups)});
    read_result(path);
    read_result(path, Reading::ends);
  });
}
