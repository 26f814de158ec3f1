// The inelastic law with any restitution as a function of the closing speed, for runs that a caller holds
// (tools/run/run.hpp): in double, in gaps, one collision after the other.

#include "cradle/tools/engines/engine_of.hpp"

namespace cradle::tools {

namespace {

// A constant function gives the bits of Inelastic.
class FunctionLaw {
 public:
  static constexpr bool bounces_only = true;

  explicit FunctionLaw(std::function<double(double)> restitution) : restitution_(std::move(restitution)) {}

  template <class Masses> Outcome<double> operator()(const double& w, const Masses& masses) const {
    const double restitution = restitution_(w);
    if (!(restitution >= 0 && restitution <= 1))
      throw std::domain_error(fmt::format("restitution: the function is beyond [0, 1] (found {} for the closing speed "
                                          "{}): let it return a number in between",
                                          restitution, w));
    return Inelastic<double>(restitution)(w, masses);
  }

 private:
  std::function<double(double)> restitution_;
};

using FunctionRun = Simulation<double, FunctionLaw, GapChain<double, IndividualMasses<double>>>;

}  // namespace

// The function may be called from the caller's thread only.
template <> struct SegmentsFor<FunctionRun> { using Type = NoSegments; };

std::unique_ptr<Engine<double>> engine_with(const std::function<double(double)>& restitution, const Scene& scene,
                                            const std::shared_ptr<const cradle::Particles<double>>& particles,
                                            const Policy<double>& policy) {
  const auto refuse = [&](const char* key, const std::string& advice) {
    throw Error(scene.place(key), "not with a restitution that is a function", "", advice);
  };
  if (particles_merge(scene)) refuse("law.type", "give \"inelastic\", without run.collapse = \"merge\"");
  if (scene.run.collapse == scene::CollapsePolicy::contact_time) refuse("run.collapse", "give \"cutoff\" or \"stop\"");
  if (scene.run.coordinates == Coordinates::absolute) refuse("run.coordinates", "give \"gaps\"");
  if (scene.gravity.acts()) refuse("gravity.acceleration", "remove it");
  if (scene.walls.shaken()) refuse("walls", "give walls without motion");
  if (far_apart(*particles)) refuse("initial", "give masses that differ by a factor of 10000 at most");
  return std::make_unique<EngineOf<double, FunctionRun>>(
      Workers(), FunctionLaw(restitution),
      GapChain<double, IndividualMasses<double>>(particles, number<double>(scene.run.start)), policy);
}

}  // namespace cradle::tools
