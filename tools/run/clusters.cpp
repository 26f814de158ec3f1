// The paper's model of the two heaviest clusters, equation (16), integrated in double. It has no particles. Its result
// has the layout of any run (series, series/heaviest), and also the force (14) over twice the width of the zone and a
// table of the meetings of the clusters.
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

#include <chrono>
#include <limits>
#include <utility>
#include <vector>

#include "cradle/core/theory/wet_clusters.hpp"
#include "cradle/core/theory/wet_zone.hpp"
#include "cradle/tools/record/series.hpp"
#include "cradle/tools/run/run.hpp"

namespace cradle::tools {

namespace {

namespace odeint = boost::numeric::odeint;

// Tolerance per step of the integrator, in units of L and u0. At t = 1e4 the error of x is about 1000 times that (from
// the closed form of (17)).
constexpr double tolerance = 1e-12;

using Stepper = odeint::result_of::make_dense_output<odeint::runge_kutta_dopri5<theory::ClusterState>>::type;
using Motion = theory::ClusterMotion<theory::ZoneForce, Stepper>;

Motion motion_of(const Scene& scene, const theory::WetZone<double>& zone) {
  const Initial& initial = scene.initial;
  const auto meeting = static_cast<theory::Meeting>(initial.meeting);
  const theory::ClusterRules rules{1, scene.law.loss.value, meeting, zone.half_width(), initial.speed.value};
  const double incoming = 2 * initial.speed.value / initial.spacing.value;  // mass per time, from both sides
  const auto start = [&](std::size_t i) {
    return theory::ClusterStart{Decimal(initial.x[i]).value, Decimal(initial.v[i]).value,
                                initial.growth[i].value * incoming};
  };
  const auto stepper =
      odeint::make_dense_output(tolerance, tolerance, odeint::runge_kutta_dopri5<theory::ClusterState>());
  return {theory::ZoneForce(zone), rules, {start(0), start(1)}, scene.run.start.value, stepper};
}

class Recorder {
 public:
  void add(double time, const Motion& motion, double loss) {
    const auto first = motion.first();
    const auto second = motion.second();
    time_.push_back(time);
    energy_.push_back(kinetic(first) + (second ? kinetic(*second) : 0));
    const auto& meetings = motion.meetings();
    for (; seen_ < meetings.size(); ++seen_) {
      total_lost_ += meetings[seen_].stuck ? meetings[seen_].relative_energy : loss;
      total_merges_ += meetings[seen_].stuck;
    }
    lost_.push_back(total_lost_);
    collisions_.push_back(seen_);
    merges_.push_back(total_merges_);
    const bool swapped = second && !motion.first_is_left();
    if (!swapped) add(0, first);
    if (second)
      add(1, *second);
    else
      add(std::numeric_limits<std::uint64_t>::max(), {none, none, none});
    if (swapped) add(0, first);
  }

  double energy() const { return energy_.back(); }
  std::uint64_t merges() const { return total_merges_; }

  void put_tables(Sink& sink) && {
    auto tables = cluster_series_tables();
    sink.add(filled(std::move(tables[0]), std::move(time_), std::move(energy_), std::move(lost_),
                    std::move(collisions_), std::move(merges_)));
    sink.add(filled(std::move(tables[1]), std::move(mass_), std::move(x_), std::move(v_), std::move(index_)));
  }

 private:
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  static double kinetic(const theory::Cluster& c) { return c.mass * c.v * c.v / 2; }
  void add(std::uint64_t index, const theory::Cluster& c) {
    mass_.push_back(c.mass);
    x_.push_back(c.x);
    v_.push_back(c.v);
    index_.push_back(index);
  }

  std::vector<double> time_, energy_, lost_, mass_, x_, v_;
  std::vector<std::uint64_t> collisions_, merges_, index_;
  std::size_t seen_ = 0;  // meetings until now, and their outcomes
  double total_lost_ = 0;
  std::uint64_t total_merges_ = 0;
};

Group force_table(const theory::WetZone<double>& zone) {
  constexpr int steps = 400;
  std::vector<double> x, force, printed;
  for (int k = 0; k <= steps; ++k) {
    x.push_back(zone.width() * (2. * k / steps - 1));
    force.push_back(zone.force(x.back()));
    printed.push_back(zone.force_printed(x.back()));
  }
  return {"force",
          {{"half_width", zone.half_width()},
           {"outer_force", zone.row_force()},
           {"outer_force_printed", zone.row_force_printed()}},
          {{"x", "l", "position of a heavy cluster", std::move(x)},
           {"force", "m l/t^2", "force on it, equations (14) and (15)", std::move(force)},
           {"force_printed", "m l/t^2", "the same with the outer force as printed, n0 E_loss", std::move(printed)}}};
}

Group meetings_table(const std::vector<theory::ClusterMeeting>& meetings) {
  using Meeting = theory::ClusterMeeting;
  return {"meetings",
          {},
          {{"time", "t", "when the clusters met", numbers_of(meetings, &Meeting::time)},
           {"x", "l", "where", numbers_of(meetings, &Meeting::x)},
           {"closing_speed", "l/t", "closing speed before", numbers_of(meetings, &Meeting::closing_speed)},
           {"relative_energy", "m l^2/t^2", "mu w^2/2 before, to be compared with E_loss",
            numbers_of(meetings, &Meeting::relative_energy)},
           {"stuck", "1", "1 where they stuck, 0 where they passed", numbers_of(meetings, &Meeting::stuck)}}};
}

}  // namespace

RunOutcome run_clusters(const Scene& scene, const RunOptions& options, Sink& sink) {
  const auto started = std::chrono::steady_clock::now();
  if (options.observer != nullptr)
    throw Error({"", 0, "initial.type"}, "no collisions to compare", "clusters, a model", "give a scene of particles");
  const theory::WetZone<double> zone({scene.law.loss.value, scene.initial.speed.value, scene.initial.spacing.value});
  Motion motion = motion_of(scene, zone);
  const double loss = scene.initial.meeting == scene::Meeting::energy ? scene.law.loss.value : 0;
  Recorder recorder;
  RunOutcome end;
  const Times samples(series_times(scene), rounding(scene));
  for (std::size_t k = 0; k < samples.size(); ++k) {
    end.time = samples[k].value;
    motion.advance(end.time);
    recorder.add(end.time, motion, loss);
    if (options.interrupt == nullptr) continue;
    options.interrupt->heed();
    if (options.interrupt->signal() == 0) continue;
    end.end = RunEnd::interrupted;
    break;
  }
  if (end.end == RunEnd::reached) {
    end.time = scene.run.until.value;
    motion.advance(end.time);
  }
  end.collisions = motion.meetings().size();
  end.merges = recorder.merges();
  end.energy = recorder.energy();
  std::vector<Attribute> attributes = provenance(scene, precision_name(scene.run), end_row(end.end).text);
  attributes.emplace_back("integrator", std::string("Dormand-Prince 5(4), steps end where the force jumps"));
  attributes.emplace_back("relative_tolerance", tolerance);
  attributes.emplace_back("absolute_tolerance", tolerance);  // x in L, v in u0
  std::move(recorder).put_tables(sink);
  sink.add(meetings_table(motion.meetings()));
  sink.add(force_table(zone));
  end.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  sink.end(std::move(attributes), end.end);
  return end;
}

}  // namespace cradle::tools
