// The checker of core/certify beside a run, in one kind of balls. Compiled once per kind (tools/CMakeLists.txt).
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <future>
#include <limits>
#include <memory>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "cradle/core/certify/checker.hpp"
#include "cradle/precision/ball_text.hpp"
#include "cradle/tools/proof/agreement.hpp"
#include "cradle/tools/proof/certificate.hpp"
#include "cradle/tools/setup/initial_state.hpp"

namespace cradle::tools {

template <Enclosing N> CertainLaw<N> certain_law(const Scene& scene) {
  using Kind = typename CertainLaw<N>::Kind;
  CertainLaw<N> law;
  if (scene.law.type == LawType::sticky) {
    law.kind = Kind::sticky;
    return law;
  }
  if (scene.law.type == LawType::wet) {
    law.kind = Kind::wet;
    law.loss = number<N>(scene.law.loss);
    return law;
  }
  law.restitution = number<N>(scene.law.restitution);
  law.elastic = scene.law.restitution == Decimal("1");
  if (scene.run.collapse == tools::scene::CollapsePolicy::merge) {
    law.kind = Kind::merging;
    law.merge_speed = number<N>(scene.run.merge_speed);
    return law;
  }
  // To elastic particles a cut-off does nothing; under gravity it holds for walls too.
  const bool acts = !law.elastic || scene.gravity.acts();
  if (acts && scene.law.cutoff > Decimal("0")) law.cutoff = number<N>(scene.law.cutoff);
  if (!law.elastic && scene.law.cutoff_exponent) law.cutoff_exponent = number<N>(*scene.law.cutoff_exponent);
  if (acts && scene.run.collapse == tools::scene::CollapsePolicy::contact_time)
    law.contact_time = number<N>(scene.run.contact_time);
  return law;
}

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
    if (const Group* events = result.find("events"))
      for (const Column& column : events->columns) {
        const auto* times = std::get_if<std::vector<double>>(&column.values);
        if (column.name != "time" || times == nullptr) continue;
        for (std::size_t k = 0; k < meetings_.size() && k < times->size(); ++k)
          rests.add("events/time_low", k, meetings_[k].time - exactly<N>((*times)[k]), 0);
      }
    rests.put(result);
    return {};
  }

 private:
  static Enclosed enclosed(const N& x) { return {in_decimals(x), in_doubles(x), static_cast<long double>(x.radius())}; }
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

  ReportedDoubt reported(const Disagreement& broken, double time) const {
    return {
        Check::agreement, true,           -1, -1, time, checker_.proved().collisions, broken.of_run, broken.of_proof,
        broken.bound,     broken.quantity};
  }

  // Checks one collision and keeps its time and closing speed, which the file has, too.
  void one_collision(ParticleIndex left, ParticleIndex right, double time) {
    if (const auto doubt = checker_.collision(left, right)) {
      certificate_.doubt = reported(*doubt, time);
      throw ProofEnds();
    }
    meetings_.push_back({start_ + checker_.last().time, checker_.last().closing});
  }

  void inspect(const RequestedTime& asked, const RunSample& sample, bool of_series) {
    const N time = number<N>(asked.time) - start_;
    const CertainState<N> state = sample.at_collision ? checker_.state_now() : checker_.state_at(time);
    snapshots_ += asked.of_snapshots;
    if (state.doubt) {
      // A collision just at the time of a sample leaves that open, not what comes after.
      if (!asked.last) return;
      certificate_.doubt = reported(*state.doubt, sample.time.value);
    } else {
      compare(sample, asked, time, state, of_series);
    }
    if (certificate_.doubt) throw ProofEnds();
    add_sample(sample, asked, state);
    if (asked.of_snapshots) add_snapshot(time, sample.time.value);
  }

  // All that the run has of what is proved of it. A collision on the wrong side of a threshold need not change their
  // sequence; and what the program gets wrong here or there would be called proved.
  void compare(const RunSample& sample, const RequestedTime& asked, const N& time, const CertainState<N>& state,
               bool of_series) {
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
    const auto same_number = [&](const std::string& name, const std::string& column, const std::string& of_run,
                                 const std::optional<N>& of_proof, long double bound) {
      run.number(name, of_run, of_proof, bound);
      of_file(column, of_proof, bound);
    };
    same_count("collisions", "collisions", sample.counts.collisions, proved.collisions);
    same_count("merges", "merges", sample.counts.merges, proved.merges);
    // To elastic particles a cut-off does nothing, and without gravity none of them is counted here.
    if (!law_.elastic || particles_->fall())
      same_count("collisions_below_cutoff", "collisions_below_cutoff", sample.counts.below_cutoff, proved.below_cutoff);
    if (sample.at_collision)
      same_number("time of the last collision", "time", sample.time.text, start_ + state.time,
                  time_error(errors, since, static_cast<long double>(state.closing.least_size())));
    else
      same_number("time of the sample", "time", sample.time.text, number<N>(asked.time), 8 * sample.epsilon * since);
    same_number("energy", "energy", sample.energy, state.energy, errors.energy);
    if (!particles_->walled() && !particles_->fall())
      of_file("energy_lost", particles_->kinetic_energy() - state.energy, 2 * errors.energy);
    for (const auto& [name, of_run, of_proof] : {std::tuple("front_left", &sample.front_left, &state.front_left),
                                                 std::tuple("front_right", &sample.front_right, &state.front_right)}) {
      run.place(name, *of_run, *of_proof);
      if (!particles_->on_ring()) of_file(name, *of_proof, errors.place);
    }
    for (const End end : {End::left, End::right}) {
      in_file = of_series && particles_->wall(end) != nullptr;
      const auto k = static_cast<std::size_t>(end);
      const SampledWall& of_run = sample.walls[k];
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
    if (asked.of_snapshots) compare_particles(sample.particles, time, run);
    if (const auto& broken = run.broken()) certificate_.doubt = reported(*broken, sample.time.value);
  }
  static long double time_error(const RunErrors& errors, long double since, long double closing) {
    return closing > 0 ? 2 * (errors.place + since * errors.speed) / closing + errors.place
                       : std::numeric_limits<long double>::infinity();
  }
  static long double of_balls() { return from_text<long double>(to_text(M(std::numeric_limits<M>::epsilon()))); }

  void compare_particles(const SampledParticles& particles, const N& time, Agreement<N>& run) {
    std::unordered_map<ParticleIndex, std::size_t> at;  // by cluster
    for (std::size_t j = 0; j < particles.index.size(); ++j)
      if (const auto cluster = checker_.cluster(particles.index[j]))
        run.count("particles of the snapshot in one cluster", at.emplace(*cluster, j).second ? 1 : 2, 1);
    std::vector<std::optional<ProvedParticle>> rows(particles.index.size());
    checker_.for_each(time, [&](ParticleIndex particle, const N& m, const N& x, const N& v) {
      const auto found = at.find(particle);
      const bool there = found != at.end();
      if (!there && (particle < particles.from || particle > particles.to)) return;
      const auto number = [&](const char* what, const std::vector<std::string>& all, const N& of_proof,
                              long double bound) {
        const auto quantity = [&] { return fmt::format("{} of particle {} in the snapshot", what, particle); };
        run.number(quantity, there ? all[found->second] : std::string(), of_proof, bound);
      };
      const N place = there ? nearest_image(x, particles.x[found->second]) : x;
      number("m", particles.m, m, run.errors().mass);
      number("x", particles.x, place, run.errors().place);
      number("v", particles.v, v, run.errors().speed);
      if (there) rows[found->second] = ProvedParticle{m, place, v, x};
    });
    add_particles(rows);
  }
  // The rows of a snapshot in the file, from left to right.
  struct ProvedParticle {
    N m, x, v, unfolded;
  };
  // A place on a ring and so many whole turns that it is nearest to another one.
  static N turned(N x, const N& near, const N& length) {
    for (double turns = 0x1p53; std::abs(turns) >= 0x1p52 && std::isfinite(turns);) {  // a double has not all digits
      turns = std::round(to_double(N((near - x) / length)));
      if (std::isfinite(turns)) x = x + N(turns) * length;
    }
    return x;
  }
  // The way round a ring from a particle to the next one, wherever the run has folded them to.
  N way(const ProvedParticle& from, const ProvedParticle& to, bool single) const {
    const N length = particles_->circumference(), way = turned(N(to.unfolded - from.unfolded), N(0), length);
    return single || way < N(0) ? N(way + length) : way;
  }
  void add_particles(const std::vector<std::optional<ProvedParticle>>& rows) {
    const std::string table = fmt::format("snapshots/{:04}/", snapshots_ - 1);
    const auto add = [&](const char* column, std::size_t j, std::optional<N> proved, long double bound) {
      tables_.add(table + column, j, std::move(proved), bound);
    };
    const bool on_ring = particles_->on_ring();
    between_.clear();
    for (std::size_t j = 0; j < rows.size(); ++j) {
      if (!rows[j]) continue;
      const ProvedParticle& row = *rows[j];
      add("m", j, row.m, errors_.mass);
      add("x", j, row.x, errors_.place);
      add("v", j, row.v, errors_.speed);
      if (j + 1 == rows.size() && !on_ring) break;
      if (const auto& next = rows[j + 1 < rows.size() ? j + 1 : 0]) {
        const N gap = on_ring ? way(row, *next, rows.size() == 1) : N(next->x - row.x);
        between_.push_back({enclosed(gap), enclosed(row.v - next->v)});
        add("gap", j, gap, errors_.gap + errors_.of_gap * static_cast<long double>(gap.size()));
        add("closing_speed", j, row.v - next->v, 2 * errors_.speed);
      } else {
        between_.push_back({});
      }
    }
  }
  // On a ring: the run folds places to one circumference.
  N nearest_image(const N& x, const std::string& of_run) const {
    if (!particles_->on_ring() || of_run.find('n') != of_run.npos) return x;
    return turned(x, from_text<N>(of_run), particles_->circumference());
  }

  void add_sample(const RunSample& sample, const RequestedTime& asked, const CertainState<N>& state) {
    // At the last collision the time is that of the exact system, which has made the collision by then.
    const N last = start_ + state.time;
    CertainSample proved_sample{sample.at_collision ? to_double(last) : sample.time.value,
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

  void add_snapshot(const N& time, double of_run) {
    const std::size_t number = snapshots_ - 1;  // that of the run's
    Group doubles{fmt::format("certificate/snapshots/{:04}", number), {{"time", of_run}}, {}},
        exact{fmt::format("exact/snapshots/{:04}", number), {{"time", of_run}}, {}};
    std::vector<std::uint64_t> index;
    Bounds places, velocities, gaps, closing_speeds;
    checker_.for_each(time, [&](ParticleIndex particle, const N&, const N& x, const N& v) {
      index.push_back(static_cast<std::uint64_t>(particle));
      places.add(enclosed(x)), velocities.add(enclosed(v));
    });
    for (const auto& [gap, closing] : between_) gaps.add(gap), closing_speeds.add(closing);
    for (Group* group : {&doubles, &exact}) {
      group->columns.push_back({"index", "1", "of a particle of the cluster, at the start", index});
      group->columns.back().names = true;
    }
    places.put(doubles, exact, "x", "l", "position");
    velocities.put(doubles, exact, "v", "l/t", "velocity");
    gaps.put(doubles, exact, "gap", "l", "distance between a row of the run's snapshot and the next");
    closing_speeds.put(doubles, exact, "closing_speed", "l/t", "closing speed of these two");
    certificate_.snapshots.push_back(std::move(doubles));
    certificate_.snapshots.push_back(std::move(exact));
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
    if (!doubt) return;
    certificate_.doubt = reported(doubt->doubt, checked_.times[doubt->number]);
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
  struct Meeting {
    N time, closing;
  };
  std::vector<Meeting> meetings_;                       // those that the file has
  std::vector<std::pair<Enclosed, Enclosed>> between_;  // gaps and closing speeds of the last snapshot
  RunErrors errors_;
  long double since_ = 0;
  std::size_t snapshots_ = 0, series_rows_ = 0;  // how many the run has taken
  bool beside_ = false;
  Proposed proposed_, checked_;                      // next and last
  std::future<std::optional<DoubtAt<N>>> checking_;  // last: waits for the thread at the end
};

template <class M> std::unique_ptr<Certifier> certifier_in(const Scene& scene, unsigned digits) {
  return std::make_unique<CertifierIn<M>>(scene, digits);
}

}  // namespace cradle::tools
