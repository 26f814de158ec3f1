// The replicas of one ensemble, run by one thread, one after the other. What is the same for all of them is made once:
// a replica begins the run again that the one before has left (tools/run/scene_run.hpp), and gives back numbers only.
#pragma once

#include <memory>
#include <vector>

#include "cradle/tools/ensemble/state.hpp"
#include "cradle/tools/run/scene_run.hpp"
#include "cradle/tools/support/interrupt.hpp"

namespace cradle::tools {

class ReplicaRun {
 public:
  /// Both must outlive this.
  ReplicaRun(const EnsembleState& ensemble, Interrupt& interrupt);

  const EnsembleState& ensemble() const { return ensemble_; }
  /// Runs a replica and adds it to the record, also if it fails. Throws ReplicaAbandoned if it is interrupted.
  void add(ReplicaIndex replica, EnsembleRecord& to);

 private:
  // Keeps the columns of the series, whose memory is used again, apart from other tables.
  class Numbers final : public MemorySink {
   public:
    Numbers() : MemorySink(Tables::for_statistics) {}
    bool take_series(std::vector<NumberColumn>& rows) override;
    void begin_again();

    ReplicaLayout::SeriesNumbers series;
  };

  const RunOutcome& run_again();

  const EnsembleState& ensemble_;
  RunOptions options_;
  Scene scene_;
  Numbers numbers_;
  std::unique_ptr<SceneRun> run_;
  ReplicaRow row_;
  std::vector<double> values_;
};

}  // namespace cradle::tools
