// Collects correlations of tagged particles, structure factors and pair distributions at the times of a scene
// (core/observe/correlations.hpp, structure.hpp), and puts them into their tables.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cradle/tools/record/schedule.hpp"
#include "cradle/tools/record/tables.hpp"

namespace cradle::tools {

/// One measure of the places of particles, the structure factor or the pair distribution.
template <Real T, class Measure> class PlaceRecorder {
 public:
  using Table = Group (*)(const std::string& name, const Scene& scene);
  /// `averaged`, `at`: the times of its average and of its tables.
  PlaceRecorder(Measure measure, std::string name, Table table, const PlaceTimes& wanted, const Scene& scene,
                const Times<T>& averaged, const Times<T>& at)
      : measure_(std::move(measure)), name_(std::move(name)), table_(table), wanted_(wanted), scene_(scene),
        averaged_(averaged), at_(at),
        means_(table_(name_, scene_).columns.front().rows(), std::max<std::size_t>(averaged.size(), 1)) {}

  bool due(const T& time) const { return averaged_.hold(time) || at_.hold(time); }
  /// If the loop over particles is stopped, it throws WalkStopped.
  void find(const Configuration<T>& now, const cradle::Particles<T>& particles, const T& elapsed,
            const std::function<bool()>& stopped) {
    found_ = measure_(now, particles, elapsed, stopped);
  }
  /// What was found at this time.
  template <class Put> void add(const T& time, Put put) {
    if (averaged_.hold(time)) means_.add(found_);
    if (const auto given = at_.find(time))
      put(at_time(table_(fmt::format("{}/{:04}", name_, written_++), scene_), given->rounded, found_));
  }
  /// The average, if it has samples; `partial`: before it has all of them, too.
  std::optional<Group> average(bool partial) const {
    if (means_.samples() == 0 || !(partial || means_.complete())) return {};
    return averaged(table_(name_ + "_average", scene_), means_, wanted_);
  }

  static auto state(auto& self) { return std::tie(self.written_, self.means_); }

 private:
  Measure measure_;
  std::string name_;
  Table table_;
  const PlaceTimes& wanted_;
  const Scene& scene_;
  const Times<T>&averaged_, &at_;
  SampledMeans means_;
  std::uint64_t written_ = 0;  // tables at times
  std::vector<double> found_;
};

template <Real T> class CorrelationRecorder {
 public:
  static bool wanted(const Output& output) {
    return output.correlations.every || output.structure.any() || output.pair_distribution.any();
  }
  /// Throws Error for more tagged particles than memory holds.
  CorrelationRecorder(const Scene& scene, const cradle::Particles<T>& particles, const Schedule<T>& plan)
      : scene_(scene), particles_(particles), times_(plan.correlations) {
    const Output& output = scene.output;
    if (output.correlations.every) {
      tagged_.emplace(particles, static_cast<ParticleIndex>(output.correlations.tag_every));
      constexpr double most = 4e9;
      const auto count = static_cast<double>(tagged_->size());
      if (const double bytes = Correlator::bytes(count, longest_lag(scene)); bytes > most)
        throw Error({scene.name, 0, "output.correlations.tag_every"}, "more tagged particles than memory is for",
                    fmt::format("{} of them, {:.2g} bytes", tagged_->size(), bytes),
                    fmt::format("give {:.0f} or more, or a shorter output.correlations.longest",
                                static_cast<double>(output.correlations.tag_every) * std::ceil(bytes / most)));
      correlator_.emplace(tagged_->size(), longest_lag(scene));
    }
    if (output.structure.any())
      structure_.emplace(structure_factor(scene), "structure", structure_table, output.structure, scene, plan.structure,
                         plan.structure_at);
    if (output.pair_distribution.any())
      pairs_.emplace(pair_distribution(scene), "pair_distribution", pair_distribution_table, output.pair_distribution,
                     scene, plan.pairs, plan.pairs_at);
  }

  bool due(const T& time) const {
    return times_.hold(time) || (structure_ && structure_->due(time)) || (pairs_ && pairs_->due(time));
  }
  /// Measures, and changes nothing yet. If a loop over particles is stopped, it throws WalkStopped.
  void find(const Configuration<T>& now, const T& time, const std::function<bool()>& stopped) {
    const T elapsed = time - number<T>(scene_.run.start);
    if (times_.hold(time)) tagged_->find(now, elapsed);
    if (structure_ && structure_->due(time)) structure_->find(now, particles_, elapsed, stopped);
    if (pairs_ && pairs_->due(time)) pairs_->find(now, particles_, elapsed, stopped);
  }
  /// What was found at this time; gives tables of this time to `put`.
  template <class Put> void add(const T& time, Put put) {
    if (times_.hold(time)) correlator_->add(tagged_->displacement(), tagged_->velocity());
    if (structure_) structure_->add(time, put);
    if (pairs_) pairs_->add(time, put);
  }

  /// `partial`: also what does not cover its whole time yet.
  std::vector<Group> tables(bool partial) const {
    std::vector<Group> all;
    if (correlator_ && correlator_->samples() > 0 && (partial || correlator_->samples() == times_.size()))
      all.push_back(correlations_result(*correlator_, tagged_->size(), scene_));
    if (auto mean = structure_ ? structure_->average(partial) : std::nullopt) all.push_back(std::move(*mean));
    if (auto mean = pairs_ ? pairs_->average(partial) : std::nullopt) all.push_back(std::move(*mean));
    return all;
  }

  static auto state(auto& self) { return std::tie(self.correlator_, self.structure_, self.pairs_); }
  void loaded() const {
    const Output& output = scene_.output;
    require_state(correlator_.has_value() == output.correlations.every.has_value(), "correlations");
    require_state(structure_.has_value() == output.structure.any(), "structure factor");
    require_state(pairs_.has_value() == output.pair_distribution.any(), "pair distribution");
  }

 private:
  const Scene& scene_;
  const cradle::Particles<T>& particles_;
  const Times<T>& times_;
  std::optional<TaggedParticles<T>> tagged_;
  std::optional<Correlator> correlator_;
  std::optional<PlaceRecorder<T, StructureFactor>> structure_;
  std::optional<PlaceRecorder<T, PairDistribution>> pairs_;
};

}  // namespace cradle::tools
