#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/run/in_precision.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/run/schedule.hpp"
#include "cradle/tools/scene/list_file.hpp"

namespace cradle::tools {

namespace {

// Bodies of two rows that have run into each other.
double reached(const Scene& scene) {
  const double span = scene.run.until.value - scene.run.start.value;
  return std::min(static_cast<double>(scene.initial.particles),
                  2 * scene.initial.speed.value * span / scene.initial.spacing.value);
}

double expected_bodies(const Scene& scene, double listed) {
  if (scene.initial.type == InitialType::list) return listed;
  if (scene.initial.general_rows())
    return static_cast<double>(scene.initial.left.particles + scene.initial.right.particles);
  const bool streamed = scene.initial.type == InitialType::rows && scene.run.coordinates == Coordinates::gaps;
  if (!streamed) return static_cast<double>(scene.initial.particles);
  // Wet bodies end up in the clusters; 14 to 17 u0^2/E_loss of them are on their way in the scenes of Figs. 7 and 11.
  const double speed = scene.initial.speed.value;
  return scene.law.type == LawType::wet ? std::min(reached(scene), 20 * speed * speed / scene.law.loss.value)
                                        : reached(scene);
}

// Contacts of two rows. Inelastic ones, before collapse: bodies i from the left and j from the right meet once, as in
// the elastic gas, K(K + 1)/2 with K = 2 u0 t/l; they make fewer at first, more later. Wet bodies that the front has
// reached lose their energy m u0^2/2 by E_loss a contact and half of that in the last one (3 contacts a body at E_loss
// = .05, as counted in Fig. 11). Sticky ones merge once. Nothing is known in general.
std::optional<double> expected_contacts(const Scene& scene) {
  if (scene.initial.type != InitialType::rows || scene.initial.general_rows()) return std::nullopt;
  const double bodies = reached(scene), met = std::min(bodies, static_cast<double>(scene.initial.particles) / 2);
  const double elastic = met * (met + 1) / 2, energy = scene.initial.speed.value * scene.initial.speed.value / 2;
  switch (scene.law.type) {
  case LawType::inelastic:
    return elastic;
  case LawType::wet:
    return std::min(elastic, bodies * (energy / scene.law.loss.value + 0.5));
  case LawType::sticky:
    return std::max(0.0, bodies - 1);
  }
  return std::nullopt;
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
    fmt::print("contacts: about {:.2g}{}\n", *contacts,
               scene.law.type == LawType::inelastic ? " before inelastic collapse, without limit after it" : "");
    fmt::print("time: about {:.2g} s at {:.0g} contacts/s\n", *contacts / contacts_per_second, contacts_per_second);
    if (scene.output.events) memory += bytes_per_event * *contacts;
  } else {
    fmt::print("contacts and time: not known beforehand for this initial state\n");
  }
  fmt::print("memory: about {:.2g} MB\n", memory * 1e-6);
  return Exit::done;
}

}  // namespace

void add_check(CommandLine& program) {
  Command command =
      program.add("check", "validate a scene without running it: effective values, expected cost", "cradle check fig2");
  const auto options = std::make_shared<CommonOptions>();
  add_common_options(command, *options);
  command.does([options] { return check(*options); });
}

}  // namespace cradle::tools
