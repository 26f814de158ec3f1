// A CSV list of particles.
#include <sstream>

#include "cradle/tests/fuzz/fuzz.hpp"
#include "cradle/tools/setup/list_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cradle;
  return fuzz::refused_or_read(data, size, [](const std::string& text) {
    std::istringstream csv(text);
    tools::parse_list(csv, "particles.csv", tools::Run());
  });
}
