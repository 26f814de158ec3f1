#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/in_precision.hpp"
#include "cradle/tools/list_file.hpp"
#include "cradle/tools/run.hpp"
#include "cradle/tools/schedule.hpp"

namespace cradle::tools {

namespace {

// Contacts of two rows before collapse: bodies i from the left and j from the right meet once, as in the elastic gas,
// K(K + 1)/2 with K = 2 u0 t/l; inelastic rows make fewer at first, more later. Nothing is known in general.
std::optional<double> expected_contacts(const Scene& scene) {
  if (scene.initial.type != InitialType::rows || scene.initial.general_rows()) return std::nullopt;
  const double span = scene.run.until.value - scene.run.start.value;
  const double met = std::min(2 * scene.initial.speed.value * span / scene.initial.spacing.value,
                              static_cast<double>(scene.initial.particles) / 2);
  return met * (met + 1) / 2;
}

double expected_bodies(const Scene& scene, double listed) {
  if (scene.initial.type == InitialType::list) return listed;
  if (scene.initial.general_rows() || scene.run.coordinates == Coordinates::absolute)
    return static_cast<double>(scene.initial.general_rows()
                                   ? scene.initial.left.particles + scene.initial.right.particles
                                   : scene.initial.particles);
  const double span = scene.run.until.value - scene.run.start.value;
  return std::min(static_cast<double>(scene.initial.particles),
                  2 * scene.initial.speed.value * span / scene.initial.spacing.value);
}

Exit check(const CommonOptions& options) {
  const Scene scene = options.read();
  const double listed = scene.initial.type == InitialType::list ? static_cast<double>(read_bodies(scene).x.size()) : 0;
  for (const auto& [key, value] : values(scene, true)) fmt::print("{} = {}\n", key, value);
  check_built(scene);
  if (scene.initial.type == InitialType::clusters) {
    fmt::print("\na model of two clusters: no bodies, no contacts; below a second\n");
    return Exit::done;
  }
  if (scene.run.precision == Precision::double_)
    initial_bodies<double>(scene);  // refuses what cannot be set up
  else
    initial_bodies<long double>(scene);

  constexpr double bytes_per_body = 120, bytes_per_event = 48, contacts_per_second = 2e7;
  const double bodies = expected_bodies(scene, listed);
  double memory = 20e6 + bytes_per_body * bodies;
  fmt::print("\nbodies in the active zone at the end: {:.3g} at most\n", bodies);
  if (const auto contacts = expected_contacts(scene)) {
    fmt::print("contacts: about {:.2g} before inelastic collapse, without limit after it\n", *contacts);
    fmt::print("time: about {:.2g} s at {:.0g} contacts/s\n", *contacts / contacts_per_second, contacts_per_second);
    if (scene.output.events) memory += bytes_per_event * *contacts;
  } else {
    fmt::print("contacts and time: not known beforehand for this initial state\n");
  }
  fmt::print("memory: about {:.2g} MB\n", memory * 1e-6);
  return Exit::done;
}

}  // namespace

void add_check(CLI::App& program, Action& action) {
  auto* command =
      program.add_subcommand("check", "validate a scene without running it: effective values, expected cost");
  const auto options = std::make_shared<CommonOptions>();
  add_common_options(*command, *options);
  command->callback([&action, options] { action = [options] { return check(*options); }; });
}

}  // namespace cradle::tools
