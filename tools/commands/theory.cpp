#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/theory/theory.hpp"

namespace cradle::tools {

namespace {

struct TheoryArguments : CommonOptions {
  bool csv = false;
};

Exit theory(const TheoryArguments& options) {
  const Scene scene = options.read();
  const auto table = predictions(scene);
  if (options.csv) {
    fmt::print("{}", predictions_csv(table));
    return Exit::done;
  }
  if (table.empty()) {
    fmt::print("no predictions: the paper's are for rows and rings of particles of mass 1, at constant restitution, "
               "without walls and gravity\n");
    return Exit::done;
  }
  fmt::print("{:<31}{:<18}{:<12}{:>12}  {}\n", "quantity", "equation", "form", "t", "value");
  // Prints curves at a few times only; --csv writes all points.
  std::map<std::pair<std::string, std::string>, std::size_t> points;  // of each curve
  for (const auto& p : table) {
    if (p.t && (p.form == "printed" || points[{p.quantity, p.form}]++ % 250 != 0)) continue;
    fmt::print("{:<31}{:<18}{:<12}{:>12}  {:.15g}\n", p.quantity, p.equation, p.form,
               p.t ? fmt::format("{:.6g}", *p.t) : "", p.value);
  }
  const auto has = [&](std::string_view form) { return std::ranges::count(table, form, &Prediction::form) > 0; };
  fmt::print("\nforms: discrete: the exact recursion; continuous: a formula, the paper's corrected where it is "
             "misprinted{}.\n",
             has("cushion") ? "; cushion: an estimate, of particles between walls" : "");
  if (has("printed"))
    fmt::print("Misprints: {} As printed: form `printed`, curves in --csv.\n", law_theory(scene).misprints);
  return Exit::done;
}

}  // namespace

void add_theory(CommandLine& program) {
  Command command =
      program.add("theory", "the paper's predictions for a scene, with equation numbers", "cradle theory fig2");
  auto& options = command.runs<TheoryArguments>(theory);
  add_common_options(command, options);
  command.flag("--csv", options.csv, "all curves, as CSV: quantity,equation,form,t,value");
}

}  // namespace cradle::tools
