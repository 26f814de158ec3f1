#include "cradle/tools/run/run_sample.hpp"

namespace cradle::tools {

RunSample run_sample(const Scene& scene, const Schedule& plan, const AnyEngine& engine, const RunState& now,
                     bool at_collision) {
  const SampledState& state = now.state();
  const Number& time = now.time.exact;
  const auto text = [](const std::optional<Number>& x) { return x ? x->text() : std::string(); };
  const auto wall = [](const SampledState::Wall& of) {
    return SampledWall{of.collisions, of.given.text(), of.momentum.text(), of.dissipated.text()};
  };
  RunSample sample{.time = {now.time.meant.value, time.text()},
                   .epsilon = engine.epsilon(),
                   .requested = at_collision ? std::vector{RequestedTime{Decimal(time.text()), true, false, true}}
                                             : plan.requested(scene, time),
                   .of_series = plan.series().hold(time),
                   .at_collision = at_collision,
                   .counts = state.counts,
                   .energy = state.energy.text(),
                   .front_left = text(state.front_left),
                   .front_right = text(state.front_right),
                   .particles = {},
                   .walls = {wall(state.walls[0]), wall(state.walls[1])}};
  using enum RunState::Column;
  if (!at_collision && plan.snapshots().hold(time))
    sample.particles = {now.range().first,  now.range().second, now.index(),
                        now.column_text(x), now.column_text(v), now.column_text(m)};
  return sample;
}

}  // namespace cradle::tools
