// The checker of core/certify beside a run, in one kind of balls. Compiled once per kind (tools/CMakeLists.txt).
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <future>
#include <limits>
#include <tuple>
#include <utility>

#include "cradle/tools/proof/agreement.hpp"
#include "cradle/tools/proof/certain_law.hpp"
#include "cradle/tools/proof/certificate.hpp"
#include "cradle/tools/proof/proved_snapshots.hpp"

namespace cradle::tools {

template <class M> class CertifierIn final : public Certifier {
  using N = Ball<M>;
  using Kind = typename CertainLaw<N>::Kind;

 public:
  CertifierIn(const Scene& scene, unsigned digits)
      : start_(number<N>(scene.run.start)), law_(certain_law<N>(scene)), particles_(initial_particles<N>(scene)),
        means_(!particles_->fall() && law_.kind != Kind::merging &&
               (law_.kind != Kind::inelastic || particles_->identical_masses())),
        linear_(law_.linear() && !(particles_->fall() && particles_->walled()) && !scene.walls.left.temperature &&
                !scene.walls.right.temperature),
        events_(scene.output.events), in_gaps_(scene.run.coordinates == Coordinates::gaps), checker_(particles_, law_) {
    certificate_.digits = digits;
    certificate_.digits_text = digits == 31 ? "double-double" : fmt::format("mpfr, {} digits", digits);
    if (const auto doubt = checker_.begin()) certificate_.doubt = reported(*doubt, scene.run.start.value);
  }

  void check_beside() override { beside_ = true; }

  void collision(ParticleIndex left, ParticleIndex right, double time) override {
    if (certificate_.doubt) throw ProofEnds();
    if (events_) return one_collision(left, right, time);
    proposed_.pairs.emplace_back(left, right);
    proposed_.times.push_back(time);
    if (proposed_.pairs.size() == most_proposed) check();
  }

  void check_all() override {
    check();
    await_check();
  }

  void sample(const RunSample& sample) override {
    if (certificate_.doubt) throw ProofEnds();
    check_all();
    sample_is_open = false;
    bool of_series = sample.of_series;
    for (const RequestedTime& asked : sample.requested) {
      inspect(asked, sample, of_series && asked.of_series);
      if (asked.of_series) of_series = false;
    }
    series_rows_ += sample.of_series;
  }

  Certificate certificate() const override {
    Certificate all = certificate_;
    all.collisions = checker_.proved().collisions;
    all.in_doubles = checker_.proved().in_doubles;
    return all;
  }

  std::optional<ReportedDoubt> disagreement(Result& result) const override {
    ProvedTables<N> tables = tables_;
    N before = start_;
    for (std::size_t k = 0; k < meetings_.size(); ++k) {
      const Meeting& meeting = meetings_[k];
      const auto closing = static_cast<long double>(meeting.closing.least_size());
      const long double time = time_error(errors_, since_, closing);
      // The file has the time as a double and what it misses.
      tables.add("events/time", k, meeting.time, time);
      tables.add("events/interval", k, meeting.time - before, 2 * time);
      tables.add("events/closing_speed", k, meeting.closing, 2 * errors_.speed);
      before = meeting.time;
    }
    if (const auto broken = tables.compare(result, errors_))
      return reported(*broken, certificate_.samples.empty() ? 0 : certificate_.samples.back().time);
    tables.put(result);
    ProvedTables<N> rests;  // of the times that the file has now
    const Group* events = result.find("events");
    if (const Column* time = events == nullptr ? nullptr : events->find("time"))
      if (const auto* times = std::get_if<std::vector<double>>(&time->values))
        for (std::size_t k = 0; k < meetings_.size() && k < times->size(); ++k)
          rests.add("events/time_low", k, meetings_[k].time - exactly<N>((*times)[k]), 0);
    rests.put(result);
    return {};
  }

 private:
  static std::string middle(const N& x) { return to_text(x.middle()); }
  ReportedDoubt reported(const Doubt<N>& doubt, double time) const {
    return {doubt.check,
            doubt.refuted,
            doubt.left,
            doubt.right,
            time,
            checker_.proved().collisions,
            middle(doubt.first),
            middle(doubt.second),
            static_cast<long double>(doubt.first.radius() + doubt.second.radius())};
  }
  ReportedDoubt reported(ReportedDoubt broken, double time) const {
    broken.time = time, broken.collisions = checker_.proved().collisions;
    return broken;
  }

  // Checks one collision and keeps its time and closing speed, which the file has, too.
  void one_collision(ParticleIndex left, ParticleIndex right, double time) {
    if (const auto doubt = checker_.collision(left, right)) end(reported(*doubt, time));
    meetings_.push_back({start_ + checker_.last().time, checker_.last().closing});
  }

  void inspect(const RequestedTime& asked, const RunSample& sample, bool of_series) {
    const N time = number<N>(asked.time) - start_;
    const CertainState<N> state = sample.at_collision ? checker_.state_now() : checker_.state_at(time);
    if (state.doubt) {
      // A collision just at the time of a sample leaves that open, not what comes after.
      if (!asked.last) {
        sample_is_open = true;
        certificate_.open_samples.push_back(asked.time.text);
        return asked.of_snapshots ? snapshots_.skip() : void();
      }
      end(reported(*state.doubt, sample.time.meant.value));
    }
    compare(sample, asked, time, state, of_series);
    add_sample(sample, asked, state);
    if (asked.of_snapshots) snapshots_.add(time, sample.time.meant.value, certificate_.snapshots);
  }

  // All that the run has of what is proved of it. A collision on the wrong side of a threshold need not change their
  // sequence; and what the program gets wrong here or there would be called proved.
  void compare(const RunSample& sample, const RequestedTime& asked, const N& time, const CertainState<N>& state,
               bool of_series) {
    const SampledState& now = sample.state;
    const auto& proved = checker_.proved();
    const long double since = std::abs(to_double(time)) + 2 * std::abs(to_double(start_));
    RunErrors errors = run_errors(state.sizes, proved.collisions, means_, sample.epsilon, since,
                                  to_double(particles_->circumference()));
    if (!linear_)
      errors.of_radius = sample.epsilon / of_balls() * (static_cast<long double>(state.sizes.particles) + 64);
    if (!in_gaps_) errors.gap += 2 * errors.place;
    errors_ = errors, since_ = since;
    // Each proved number is compared with that of the run now and, if the series has a sample here, with the row of the
    // file at the end.
    Agreement<N> run(errors);
    bool in_file = of_series;
    const auto of_file = [&](const std::string& column, std::optional<N> of_proof, long double bound) {
      if (in_file) tables_.add("series/" + column, series_rows_, std::move(of_proof), bound);
    };
    const auto same_count = [&](const std::string& name, const std::string& column, std::uint64_t of_run,
                                std::uint64_t of_proof) {
      run.count(name, of_run, of_proof);
      of_file(column, N(static_cast<std::int64_t>(of_proof)), 0);
    };
    const auto same_number = [&](const std::string& name, const std::string& column, const Number& of_run,
                                 const std::optional<N>& of_proof, long double bound) {
      run.number(name, of_run.text(), of_proof, bound);
      of_file(column, of_proof, bound);
    };
    same_count("collisions", "collisions", now.counts.collisions, proved.collisions);
    same_count("merges", "merges", now.counts.merges, proved.merges);
    // To elastic particles a cut-off does nothing, and without gravity none of them is counted here.
    if (!law_.elastic || particles_->fall())
      same_count("collisions_below_cutoff", "collisions_below_cutoff", now.counts.below_cutoff, proved.below_cutoff);
    if (sample.at_collision)
      same_number("time of the last collision", "time", sample.time.exact, start_ + state.time,
                  time_error(errors, since, static_cast<long double>(state.closing.least_size())));
    else
      same_number("time of the sample", "time", sample.time.exact, number<N>(asked.time), 8 * sample.epsilon * since);
    same_number("energy", "energy", now.energy, state.energy, errors.energy);
    if (!particles_->walled() && !particles_->fall())
      of_file("energy_lost", particles_->kinetic_energy() - state.energy, 2 * errors.energy);
    for (const auto& [name, of_run, of_proof] : {std::tuple("front_left", &now.front_left, &state.front_left),
                                                 std::tuple("front_right", &now.front_right, &state.front_right)}) {
      run.number(name, *of_run ? (*of_run)->text() : "", *of_proof, errors.place);
      if (!particles_->on_ring()) of_file(name, *of_proof, errors.place);
    }
    for (const End end : {End::left, End::right}) {
      in_file = of_series && particles_->wall(end) != nullptr;
      const auto k = static_cast<std::size_t>(end);
      const SampledState::Wall& of_run = now.walls[k];
      const CertainAccount<N>& wall = state.walls[k];
      const char* const which = end == End::left ? "left" : "right";
      const std::string name = fmt::format(" the {} wall", which), column = fmt::format("wall_{}_", which);
      const long double collisions = static_cast<long double>(wall.collisions);
      same_count("collisions with" + name, column + "collisions", of_run.collisions, wall.collisions);
      same_number("energy given by" + name, column + "energy", of_run.given, wall.given,
                  collisions * errors.wall_energy);
      same_number("momentum given by" + name, column + "momentum", of_run.momentum, wall.momentum,
                  collisions * errors.wall_momentum);
      same_number("energy lost in" + name, column + "lost", of_run.dissipated, wall.dissipated,
                  collisions * errors.wall_energy);
    }
    if (asked.of_snapshots) snapshots_.compare(sample.particles, time, run);
    if (const auto& broken = run.broken()) end(reported(*broken, sample.time.meant.value));
  }
  static long double time_error(const RunErrors& errors, long double since, long double closing) {
    return closing > 0 ? 2 * (errors.place + since * errors.speed) / closing + errors.place
                       : std::numeric_limits<long double>::infinity();
  }
  static long double of_balls() { return from_text<long double>(to_text(M(std::numeric_limits<M>::epsilon()))); }

  void add_sample(const RunSample& sample, const RequestedTime& asked, const CertainState<N>& state) {
    // At the last collision the time is that of the exact system, which has made the collision by then.
    const N last = start_ + state.time;
    CertainSample proved_sample{sample.at_collision ? to_double(last) : sample.time.meant.value,
                                sample.at_collision ? in_decimals(last).high : asked.time.text,
                                asked.of_series,
                                checker_.proved().collisions,
                                enclosed(state.energy),
                                {},
                                {},
                                state.widest,
                                state.least_gap,
                                state.widest_of_gap,
                                {},
                                state.over};
    if (state.front_left) proved_sample.front_left = enclosed(*state.front_left);
    if (state.front_right) proved_sample.front_right = enclosed(*state.front_right);
    for (const End end : {End::left, End::right}) {
      const auto k = static_cast<std::size_t>(end);
      if (particles_->wall(end) == nullptr) continue;
      const CertainAccount<N>& wall = state.walls[k];
      proved_sample.walls[k] = {wall.collisions, enclosed(wall.given), enclosed(wall.dissipated)};
    }
    certificate_.samples.push_back(std::move(proved_sample));
  }

  // Checks the collisions that wait. With beside_ they are checked on another thread, after those before them.
  void check() {
    await_check();
    std::swap(proposed_, checked_);
    proposed_.pairs.clear(), proposed_.times.clear();
    const auto all = [this] { return checker_.collisions(checked_.pairs); };
    if (beside_)
      checking_ = std::async(std::launch::async, all);
    else
      report(all());
  }
  void await_check() {
    if (checking_.valid()) report(checking_.get());
  }
  void report(const std::optional<DoubtAt<N>>& doubt) {
    if (doubt) end(reported(doubt->doubt, checked_.times[doubt->number]));
  }
  [[noreturn]] void end(ReportedDoubt&& doubt) {
    certificate_.doubt = std::move(doubt);
    throw ProofEnds();
  }

  // Collisions that the run has made and that are not checked yet; at most so many wait.
  static constexpr std::size_t most_proposed = 16384;
  struct Proposed {
    std::vector<std::pair<ParticleIndex, ParticleIndex>> pairs;
    std::vector<double> times;
  };

  N start_;
  CertainLaw<N> law_;
  std::shared_ptr<const cradle::Particles<N>> particles_;
  bool means_;   // velocities after a collision are means of those before, or those that walls give
  bool linear_;  // and places and velocities linear functions of them
  bool events_, in_gaps_;
  Checker<N> checker_;
  Certificate certificate_;
  // What is proved of the run's tables, and by how much the run may be off at the last sample.
  ProvedTables<N> tables_;
  ProvedSnapshots<N> snapshots_{*particles_, checker_, tables_};
  struct Meeting {
    N time, closing;
  };
  std::vector<Meeting> meetings_;  // those that the file has
  RunErrors errors_;
  long double since_ = 0;
  std::size_t series_rows_ = 0;  // how many the run has taken
  bool beside_ = false;
  Proposed proposed_, checked_;                      // next and last
  std::future<std::optional<DoubtAt<N>>> checking_;  // last: waits for the thread at the end
};

template <class M> std::unique_ptr<Certifier> certifier_in(const Scene& scene, unsigned digits) {
  return std::make_unique<CertifierIn<M>>(scene, digits);
}

}  // namespace cradle::tools
