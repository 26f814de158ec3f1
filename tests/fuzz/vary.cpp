// Values of --vary and --point, one per line; those of points have a '!' before them. A million points are allowed, but
// take seconds with sanitizers: here the limit is some thousand.
#include <sstream>

#include "cradle/tests/fuzz/fuzz.hpp"
#include "cradle/tools/ensemble/sweep_points.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cradle;
  return fuzz::refused_or_read(data, size, [](const std::string& text) {
    tools::Sweep sweep;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
      line.starts_with('!') ? sweep.points.push_back(line.substr(1)) : sweep.vary.push_back(line);
    sweep.cuts = text.size() % 2 == 1;
    tools::sweep_points(sweep, 4096);
  });
}
