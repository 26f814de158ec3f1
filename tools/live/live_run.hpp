// A run that Python holds: a held run (tools/run/scene_run.hpp) with its tables in memory, threads of its own, and
// files: checkpoints, and the result at its end.
//
// One scene is not as in `cradle run`: a sticky gas whose scene observes no collision is computed there directly at
// each output time. Here its collisions are made, which differ by rounding, and the file is computed as `cradle run`
// does.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "cradle/tools/run/scene_run.hpp"
#include "cradle/tools/store/overwrite.hpp"
#include "cradle/tools/support/threads.hpp"

namespace cradle::tools {

struct LiveOptions {
  unsigned threads = 0;        // 0: all processors
  std::function<void()> poll;  // called some times a second during a run; what it throws leaves `advance`
  std::function<double(double)> restitution = {};  // of the closing speed, instead of the scene's law; in double only
  std::function<void(const Scene&)> begins = {};   // called before any number of the scene is made
};

class LiveRun {
 public:
  LiveRun(const Scene& scene, const LiveOptions& options);
  /// Continues from what `save` has written.
  LiveRun(const std::string& checkpoint, const LiveOptions& options);

  /// To read, to stop and to observe it.
  SceneRun& run() { return *run_; }
  const Scene& scene() const { return scene_; }
  /// As SceneRun has them.
  void advance(const Decimal& until);
  std::uint64_t step(std::uint64_t n, const Decimal& until);

  /// Writes a file from which a run can continue. Throws Error, also if the run is over.
  void save(const std::string& path);
  /// Writes the result of a run that is over. It replaces only what `cradle run` would replace. Throws Error.
  void write(const std::string& path, Force force) const;

 private:
  class PolledMemory final : public MemorySink {
   public:
    explicit PolledMemory(std::function<void()> poll) : MemorySink(Tables::for_file), poll_(std::move(poll)) {}
    void check_clock() override;

   private:
    std::function<void()> poll_;
    std::chrono::steady_clock::time_point polled_ = std::chrono::steady_clock::now();
  };

  void begin(const LiveOptions& options);
  template <class F> void with_threads(const F& f);
  void require_own_law(const char* what) const;
  Result result() const;

  Scene scene_;
  PolledMemory sink_;
  bool own_law_;  // a restitution that is a function
  unsigned threads_;
  std::optional<Threads> executor_;  // only during a call: an idle run does not limit what other code uses of threads
  std::unique_ptr<SceneRun> run_;
};

}  // namespace cradle::tools
