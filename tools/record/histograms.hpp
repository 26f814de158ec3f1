// Collects what the histograms of a scene count (core/observe/histograms.hpp), and puts it into their tables.
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "cradle/core/observe/histograms.hpp"
#include "cradle/tools/setup/initial_state.hpp"
#include "cradle/tools/record/tables.hpp"

namespace cradle::tools {

template <Real T> class HistogramRecorder {
 public:
  HistogramRecorder(const Scene& scene, ParticleIndex particles)
      : scene_(scene), collisions_(number<T>(scene.output.counting.from), number<T>(scene.output.counting.until),
                                   histogram_bins("closing_speed", scene), particles,
                                   wanted("free_flight") || wanted("pair_flight") || wanted("collisions_per_particle")),
        gaps_(histogram_bins("gap", scene)), clusters_(histogram_bins("cluster", scene)) {}

  /// Call it before the next collision, and before anything is saved or taken.
  void made(const Counts& now) { collisions_.made(now); }
  void operator()(const Collision<T>& c) { collisions_(c); }
  /// At a time of counting.
  void add(const Configuration<T>& now) {
    for (const T& gap : now.gap) gaps_.add(to_double(gap));
    if (wanted("cluster"))
      for_each_cluster(now, number<T>(*scene_.output.counting.cluster_gap),
                       [&](std::size_t particles) { clusters_.add(static_cast<double>(particles)); });
  }

  std::vector<Group> tables() const {
    std::vector<Group> all;
    const auto put = [&](std::string_view name, const OctaveHistogram& histogram) {
      if (wanted(name)) all.push_back(histogram_result(name, histogram, scene_));
    };
    put("free_flight", collisions_.free_flights);
    put("pair_flight", collisions_.pair_flights);
    put("closing_speed", collisions_.closing_speeds);
    put("dissipative_closing_speed", collisions_.dissipative_speeds);
    put("collisions_per_particle", collisions_.collisions_per_particle());
    put("gap", gaps_);
    put("cluster", clusters_);
    return all;
  }

  static auto state(auto& self) { return std::tie(self.collisions_, self.gaps_, self.clusters_); }

 private:
  bool wanted(std::string_view name) const { return scene_.output.has_histogram(name); }

  const Scene& scene_;
  CollisionHistograms<T> collisions_;
  OctaveHistogram gaps_, clusters_;
};

}  // namespace cradle::tools
