#pragma once
// Collisions without a queue, in steps of time and as vectors: the plain interface of a compiled unit. It takes a line
// of gaps (line.hpp), a law and a time, and makes all collisions up to it, or says that it could not: then the event
// loop makes them (segment.hpp). Without the unit, or if it was built without Highway, there are no steps and the event
// loop does everything. core/parallel/README.md has the proof that the result is the same.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cradle/core/parallel/steps/line.hpp"

namespace cradle {

// What steps leave to scalar code: collisions at cuts, fronts and walls, and laws that are not vectors.
class StepScalars {
 public:
  // Makes the collision at a gap; false where it is for the event loop, or comes in the wrong order. (At an edge, or
  // where particles merge.)
  virtual bool collide(std::size_t gap) = 0;
  // StepLaw::any: computes what comes of the collisions at so many inner gaps, enters it in counts and ledger, and logs
  // it where collisions are observed. (StepLaw::of_speed: the same, where numbers are out of the range of vectors.)
  virtual void outcomes(const std::uint32_t* gaps, std::size_t count) = 0;
  // An undo copy of what all of this has entered anywhere.
  virtual void keep() = 0;
  virtual void restore() = 0;

 protected:
  ~StepScalars() = default;
};

// Of Inelastic (law.hpp), for a restitution from 1/2 on and below it; of SpeedDependent; by StepScalars::outcomes; or
// Wet, of particles that pass through each other or merge.
enum class StepLaw : std::uint8_t { hard, soft, of_speed, any, wet };

// The numbers of SpeedDependent and of its functions (elementary.hpp); the cut-off is StepTask's.
struct StepRestitution {
  double missing = 0, exponent = 0, ln2 = 0, all = 0;
  int whole = 0;
  const double *odd = nullptr, *reciprocals = nullptr;
  std::size_t odds = 0, count = 0;
};

struct StepTask {
  StepLaw law = StepLaw::any;
  double restitution = 1, half_sum = 1, cutoff = 0;
  double lost = 0;  // of w^2; with unequal masses of reduced mass times w^2
  StepRestitution of_speed;
  double twice_loss = 0, below = 0, above = 0;  // of Wet; `lost` is the loss
  // Whether numbers are sums of two doubles (pairs.inl); then these are the lesser ones of those above.
  bool pairs = false;
  struct Low {
    double restitution = 0, half_sum = 0, cutoff = 0, lost = 0;
  };
  Low low;
  // Unequal masses: StepLine::fraction is the lighter mass over the sum, negative where the left particle is the
  // lighter one, StepLine::reduced the reduced mass.
  bool unequal = false;
  double floor = 0;                  // a gap below it is for the event loop
  double rounder = 0, per_fine = 0;  // the ledger's grid
  double stop = 0;                   // local time up to which collisions are made
  std::uint64_t most = 0;            // fewer collisions than that
};

// At inner gaps.
struct StepResult {
  std::uint64_t collisions = 0, below_cutoff = 0;
  double last = -StepLine::never;  // time of the last one
  double low_last = 0;             // of pairs
  double lost = 0, rest = 0;       // for Ledger::add_sums
};

// How a segment is computed: the length of a step (0: unknown), which is chosen such that it takes about so many
// passes; the number of steps between undo copies, and that of steps since the last failure. After time slabs in which
// steps failed, the next ones are left to the event loop: `rest` is how many still are, `next_rest` how many will be
// after the next failure.
struct StepPace {
  static constexpr int most = 1 << 20;
  double length = 0, passes = 5;
  int stretch = 32, since_failure = most;
  int rest = 0, next_rest = 1;

  void made(bool done) {
    rest = done ? 0 : next_rest;
    next_rest = done ? std::max(next_rest / 2, 1) : std::min(2 * next_rest, 64);
  }
};

struct Steps {
  // Makes all collisions up to `end`. Returns in how many passes, or -1: some were made in the wrong order, or one of
  // them is for the event loop.
  using Step = int (*)(StepLine& line, const StepTask& task, StepScalars& scalars, double end, StepResult& result);

  const char* target;  // the vectors for which it is compiled
  // Makes all collisions of the task; or returns false, and then the line may hold anything.
  bool (*run)(StepLine& line, const StepTask& task, StepScalars& scalars, StepPace& pace, StepResult& result);
};

// Those for the vectors of this processor that are compiled, widest first.
const std::vector<Steps>& all_steps();
// The first of them if it is faster than the event loop, else null.
const Steps* fastest_steps();

// The loop over steps (loop.cpp): it decides how long they are, and what is done where one has failed.
bool run_steps(Steps::Step step, StepLine& line, const StepTask& task, StepScalars& scalars, StepPace& pace,
               StepResult& result);

}  // namespace cradle
