#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <memory>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/result/difference.hpp"
#include "cradle/tools/result/reader.hpp"

namespace cradle::tools {

namespace {

struct DiffArguments {
  std::string first, second, rtol;
};

double tolerance(const std::string& text) {
  double value = 0;
  if (text.empty()) return value;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value) || value < 0)
    throw Error({"", 0, "--rtol"}, "not a tolerance", text, "give a number from 0 on, 1e-12 for instance");
  return value;
}

Exit diff(const DiffArguments& options) {
  const double rtol = tolerance(options.rtol);
  const Differences found =
      differences(read_result(options.first), read_result(options.second), options.first, options.second, rtol);
  for (const std::string& line : found.lines) fmt::print("{}\n", line);
  const std::string tolerated =
      found.tolerated > 0 ? fmt::format(", {} of them within --rtol {}", found.tolerated, options.rtol) : "";
  fmt::print("{}{} numbers compared{}\n",
             found.lines.empty() ? "no difference: " : fmt::format("{} differences: ", found.lines.size()),
             found.numbers, tolerated);
  return found.lines.empty() ? Exit::done : Exit::differs;
}

}  // namespace

void add_diff(CommandLine& program) {
  Command command = program.add("diff", "in what two results differ: the first difference of each column, and its size",
                                "cradle diff today.h5 yesterday.h5");
  const auto options = std::make_shared<DiffArguments>();
  command.argument("A", options->first, "result file");
  command.argument("B", options->second, "result file");
  command.option("--rtol", options->rtol, "numbers that differ by at most this, relatively, are the same (default 0)");
  command.note(
      "Status 1 where they differ. Everything in the files is compared, attributes, units and shapes included.");
  command.does([options] { return diff(*options); });
}

}  // namespace cradle::tools
