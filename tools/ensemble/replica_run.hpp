// The replicas of one ensemble, run by one thread, one after the other. What is the same for all of them is made once:
// a replica begins the run again that the one before has left (tools/run/run.hpp), and gives back numbers only.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <vector>

#include "cradle/tools/ensemble/state.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/support/interrupt.hpp"

namespace cradle::tools {

class ReplicaRun {
 public:
  /// Both must outlive this.
  ReplicaRun(const EnsembleState& ensemble, Interrupt& interrupt)
      : ensemble_(ensemble), options_{Progress::Show::never, nullptr, &interrupt},
        scene_(replica_scene(ensemble.scene(), 0)) {}

  const EnsembleState& ensemble() const { return ensemble_; }
  /// Runs a replica and adds it to the record, also if it fails. Throws ReplicaAbandoned if it is interrupted.
  void add(ReplicaIndex replica, EnsembleRecord& to) {
    const ReplicaLayout& layout = ensemble_.layout();
    scene_.initial.replica = replica;
    ReplicaTables kept;
    try {
      const auto finished = [&](const RunOutcome& run) {
        if (run.end == RunEnd::interrupted) throw ReplicaAbandoned();
        layout.put_row(replica, run, row_);
      };
      if (scene_.output.every_replica || scene_.initial.type == InitialType::clusters) {
        const RunOutcome run = run_scene(scene_, options_);  // with all its tables
        finished(run);
        values_ = layout.values(run);
        if (scene_.output.every_replica) kept = kept_tables(replica, run.result);
      } else {
        const RunOutcome& run = run_again();
        finished(run);
        layout.put_values(run.end, numbers_.series, numbers_.tables(), values_);
      }
      for (const double value : values_)
        if (std::isinf(value))
          throw Error({}, "a number beyond the range of a double, in which statistics are", fmt::format("{}", value),
                      "give other units of length or speed");
    } catch (const ReplicaAbandoned&) {
      run_.reset();
      throw;
    } catch (...) {
      run_.reset();
      return ensemble_.put_failure(to, replica, message_of_exception());
    }
    ensemble_.put(to, row_, values_);
    if (!kept.empty()) to.kept.emplace(replica, std::move(kept));
  }

 private:
  // Keeps the columns of the series, whose memory is used again, apart from other tables.
  class Numbers final : public MemorySink {
   public:
    Numbers() : MemorySink(Tables::for_statistics) {}
    bool take_series(std::vector<NumberColumn>& rows) override {
      series.resize(rows.size());
      for (std::size_t k = 0; k < rows.size(); ++k) {
        std::vector<double>& values = rows[k].values;
        if (series[k].empty()) series[k].swap(values);
        for (const double value : values) series[k].push_back(value);
        values.clear();
      }
      return true;
    }
    void begin_again() {
      for (std::vector<double>& column : series) column.clear();
      clear();
    }

    ReplicaLayout::SeriesNumbers series;
  };

  const RunOutcome& run_again() {
    numbers_.begin_again();
    if (run_)
      run_->begin_again();
    else
      run_ = begin_run(scene_, options_, numbers_);
    run_->advance(scene_.run.until);
    return *run_->over();
  }

  const EnsembleState& ensemble_;
  RunOptions options_;
  Scene scene_;
  Numbers numbers_;
  std::unique_ptr<SceneRun> run_;
  ReplicaRow row_;
  std::vector<double> values_;
};

}  // namespace cradle::tools
