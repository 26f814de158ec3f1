// A result file without its seal, which is read in a process of its own: slow, and what goes wrong there is reported
// and no more. So the fuzzer gets results as bytes, too, of any names, types and shapes: what can be written as a file
// can be read from it.
#include <unistd.h>

#include <fstream>

#include "cradle/tests/fuzz/fuzz.hpp"
#include "cradle/tools/result/reader.hpp"
#include "cradle/tools/result/result_bytes.hpp"
#include "cradle/tools/result/writer.hpp"

namespace {

using namespace cradle::tools;

std::string file_of(const std::string& bytes) {
  if (bytes.starts_with("\x89HDF")) return bytes;
  const Result result = result_of_bytes(bytes);
  for (const Group& group : result.groups)
    for (const Column& column : group.columns)
      if (column.left_out > 0) throw Error("rows that are not there", Exit::io);  // nobody writes such
  return file_image(result);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string path = "/tmp/cradle-fuzz-" + std::to_string(::getpid()) + ".h5";
  return cradle::fuzz::refused_or_read(data, size, [](const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << file_of(bytes);
    read_result(path);
    read_result(path, Reading::ends);
  });
}
