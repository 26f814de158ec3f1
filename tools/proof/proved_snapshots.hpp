// The snapshots of a run as far as they are proved: compared with those of the run, and tables of the certificate.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "cradle/core/certify/checker.hpp"
#include "cradle/precision/ball_text.hpp"
#include "cradle/tools/proof/agreement.hpp"
#include "cradle/tools/proof/certificate.hpp"

namespace cradle::tools {

template <Enclosing N> Enclosed enclosed(const N& x) {
  return {in_decimals(x), in_doubles(x), static_cast<long double>(x.radius())};
}

template <Enclosing N> class ProvedSnapshots {
 public:
  /// All three must outlive it.
  ProvedSnapshots(const cradle::Particles<N>& particles, const Checker<N>& checker, ProvedTables<N>& tables)
      : particles_(particles), checker_(checker), tables_(tables) {}

  /// Compares the particles of the run's next snapshot with those of the proof, at a time since the start; what the
  /// file then has of them is compared at the end.
  void compare(const SampledParticles& particles, const N& time, Agreement<N>& run) {
    std::unordered_map<ParticleIndex, std::size_t> at;  // by cluster
    for (std::size_t j = 0; j < particles.index.size(); ++j)
      if (const auto cluster = checker_.cluster(particles.index[j]))
        run.count("particles of the snapshot in one cluster", at.emplace(*cluster, j).second ? 1 : 2, 1);
    for (const auto& [cluster, j] : at) names_[cluster] = particles.index[j];
    std::vector<std::optional<ProvedParticle>> rows(particles.index.size());
    checker_.for_each(time, [&](ParticleIndex particle, const N& m, const N& x, const N& v) {
      const auto found = at.find(particle);
      const bool there = found != at.end();
      if (!there && (particle < particles.range.first || particle > particles.range.second)) return;
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
    add_particles(rows, run.errors());
  }
  /// Adds the tables of this snapshot, at a time since the start that is `of_run` in the run, to those of the
  /// certificate.
  void add(const N& time, double of_run, std::vector<Group>& to) {
    Group doubles{fmt::format("certificate/snapshots/{:04}", number_), {{"time", of_run}}, {}},
        exact{fmt::format("exact/snapshots/{:04}", number_), {{"time", of_run}}, {}};
    std::vector<std::uint64_t> index;
    Bounds places, velocities, gaps, closing_speeds;
    checker_.for_each(time, [&](ParticleIndex particle, const N&, const N& x, const N& v) {
      const auto name = names_.find(particle);
      index.push_back(static_cast<std::uint64_t>(name == names_.end() ? particle : name->second));
      places.add(enclosed(x)), velocities.add(enclosed(v));
    });
    for (const auto& [gap, closing] : between_) gaps.add(gap), closing_speeds.add(closing);
    for (Group* group : {&doubles, &exact}) {
      group->columns.push_back({"index", "1", "number at the start; of a cluster as in the run", index});
      group->columns.back().names = true;
    }
    places.put(doubles, exact, "x", "l", "position");
    velocities.put(doubles, exact, "v", "l/t", "velocity");
    gaps.put(doubles, exact, "gap", "l", "distance between a row of the run's snapshot and the next");
    closing_speeds.put(doubles, exact, "closing_speed", "l/t", "closing speed of these two");
    to.push_back(std::move(doubles));
    to.push_back(std::move(exact));
    between_.clear(), names_.clear();
    skip();
  }
  /// The run has this snapshot, the proof does not.
  void skip() { ++number_; }

 private:
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
    const N length = particles_.circumference(), way = turned(N(to.unfolded - from.unfolded), N(0), length);
    return single || way < N(0) ? N(way + length) : way;
  }
  void add_particles(const std::vector<std::optional<ProvedParticle>>& rows, const RunErrors& errors) {
    const std::string table = fmt::format("snapshots/{:04}/", number_);
    const auto add = [&](const char* column, std::size_t j, std::optional<N> proved, long double bound) {
      tables_.add(table + column, j, std::move(proved), bound);
    };
    const bool on_ring = particles_.on_ring();
    for (std::size_t j = 0; j < rows.size(); ++j) {
      if (!rows[j]) continue;
      const ProvedParticle& row = *rows[j];
      add("m", j, row.m, errors.mass);
      add("x", j, row.x, errors.place);
      add("v", j, row.v, errors.speed);
      if (j + 1 == rows.size() && !on_ring) break;
      if (const auto& next = rows[j + 1 < rows.size() ? j + 1 : 0]) {
        const N gap = on_ring ? way(row, *next, rows.size() == 1) : N(next->x - row.x);
        between_.push_back({enclosed(gap), enclosed(row.v - next->v)});
        add("gap", j, gap, errors.gap + errors.of_gap * static_cast<long double>(gap.size()));
        add("closing_speed", j, row.v - next->v, 2 * errors.speed);
      } else {
        between_.push_back({});
      }
    }
  }
  // On a ring: the run folds places to one circumference.
  N nearest_image(const N& x, const std::string& of_run) const {
    if (!particles_.on_ring() || of_run.find('n') != of_run.npos) return x;
    return turned(x, from_text<N>(of_run), particles_.circumference());
  }

  const cradle::Particles<N>& particles_;
  const Checker<N>& checker_;
  ProvedTables<N>& tables_;
  std::vector<std::pair<Enclosed, Enclosed>> between_;      // gaps and closing speeds of this snapshot
  std::unordered_map<ParticleIndex, ParticleIndex> names_;  // of its clusters in the run
  std::size_t number_ = 0;                                  // of this snapshot
};

}  // namespace cradle::tools
