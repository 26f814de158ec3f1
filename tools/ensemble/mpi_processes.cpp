// Rank 0 gives aligned pieces of the remaining replicas to ranks that request them, large pieces first and smaller ones
// towards the end; the threads of a rank share its pieces. Only the main thread calls MPI, and it does nothing else;
// other threads do the work. If a rank dies the launcher ends the job; the next job finds the journals of all ranks.
#include "cradle/tools/ensemble/processes.hpp"

#include <fmt/format.h>
#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <set>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>

#include "cradle/tools/ensemble/work_queue.hpp"

namespace cradle::tools {

namespace {

using namespace std::chrono_literals;

constexpr int to_leader = 1, from_leader = 2, records = 3;  // tags

// What another rank wishes of rank 0 (nothing, piece, leave), and what rank 0 answers.
enum class Kind : std::uint64_t { nothing, piece, leave, work, no_more, stop, farewell };
struct Message {
  Kind kind = Kind::nothing;
  std::uint64_t taken = 0;   // by another rank since its last message: jobs that are finished or running
  std::uint64_t signal = 0;  // of either
  JobRange jobs = {};        // work
};

// Messages are sent as raw bytes.
void send(const Message& message, int rank, int tag) {
  static_assert(std::is_trivially_copyable_v<Message>);
  MPI_Send(&message, sizeof message, MPI_BYTE, rank, tag, MPI_COMM_WORLD);
}
Message receive(int rank, int tag) {
  Message message;
  MPI_Recv(&message, sizeof message, MPI_BYTE, rank, tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return message;
}

// Records of any size, in pieces: MPI counts in int.
constexpr std::uint64_t largest_piece = std::uint64_t{1} << 30;
void send_record(std::string_view record) {
  const std::uint64_t size = record.size();
  MPI_Send(&size, 1, MPI_UINT64_T, 0, records, MPI_COMM_WORLD);
  for (std::uint64_t at = 0; at < size; at += largest_piece)
    MPI_Send(record.data() + at, static_cast<int>(std::min(largest_piece, size - at)), MPI_BYTE, 0, records,
             MPI_COMM_WORLD);
}
std::string receive_record(int rank) {
  std::uint64_t size = 0;
  MPI_Recv(&size, 1, MPI_UINT64_T, rank, records, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  std::string record(size, '\0');
  for (std::uint64_t at = 0; at < size; at += largest_piece)
    MPI_Recv(record.data() + at, static_cast<int>(std::min(largest_piece, size - at)), MPI_BYTE, rank, records,
             MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return record;
}

// The rank that has sent a message, or -1.
int sender(int rank, int tag) {
  int there = 0;
  MPI_Status status;
  MPI_Iprobe(rank, tag, MPI_COMM_WORLD, &there, &status);
  return there != 0 ? status.MPI_SOURCE : -1;
}

// Waits by polling with pauses: MPI's own waiting uses a whole processor, which other ranks may need.
template <class Condition> void wait(Condition condition) {
  while (!condition()) std::this_thread::sleep_for(1ms);
}

class MpiProcesses : public Processes {
 public:
  MpiProcesses(int processes_launched, Interrupt& interrupt) : Processes(interrupt) {
    int given = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &given);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    if (processes_launched > 1 && size_ == 1) {
      MPI_Finalize();
      throw Error({}, "the launched processes do not see each other", fmt::format("{} of them", processes_launched),
                  "use the launcher of the MPI that this program was built with");
    }
    // Ranks that are not bound to processors share all processors of their machine.
    MPI_Comm machine = MPI_COMM_NULL;
    int ranks_here = 1;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &machine);
    MPI_Comm_size(machine, &ranks_here);
    MPI_Comm_free(&machine);
    const bool bound = static_cast<long>(processors()) < ::sysconf(_SC_NPROCESSORS_ONLN);
    threads_ = bound ? processors() : std::max(1U, processors() / static_cast<unsigned>(ranks_here));
  }
  ~MpiProcesses() override { MPI_Finalize(); }

  unsigned rank() const override { return static_cast<unsigned>(rank_); }
  unsigned threads() const override { return threads_; }

  bool together(const std::function<void()>& step) override {
    std::exception_ptr error;
    try {
      step();
    } catch (...) {
      error = std::current_exception();
    }
    const int mine = error ? rank_ : size_;
    int first = size_;
    MPI_Allreduce(&mine, &first, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    if (first == size_) return true;
    ignore_signals();  // launchers send all ranks a signal as soon as the first of them has ended
    if (rank_ == first) std::rethrow_exception(error);
    return false;
  }

  int share(const std::vector<JobRange>& jobs, const std::function<void(const NextJob&)>& work,
            const std::function<void(std::uint64_t)>& others_took) override {
    or_abandon([&] {
      WorkQueue queue(work, interrupt());
      if (rank_ == 0)
        lead(queue, JobQueue(jobs), others_took);
      else
        follow(queue);
    });
    // Some ranks may have finished before a signal came: all return what rank 0 returns, which waits for all.
    int signal = interrupt().signal();
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Ibcast(&signal, 1, MPI_INT, 0, MPI_COMM_WORLD, &request);
    wait([&] {
      int done = 0;
      MPI_Test(&request, &done, MPI_STATUS_IGNORE);
      return done != 0;
    });
    return signal;
  }

  void gather(const std::function<void(const PutRecord&)>& put, const PutRecord& take) override {
    or_abandon([&] {
      if (rank_ != 0) {
        put(send_record);
        send_record({});  // the end
      } else {
        for (int rank = 1; rank < size_; ++rank)
          for (std::string record = receive_record(rank); !record.empty(); record = receive_record(rank)) take(record);
      }
    });
  }

 private:
  void lead(WorkQueue& queue, JobQueue all, const std::function<void(std::uint64_t)>& others_took) const {
    // A piece is a third of an even share of the rest: few messages at first, and no long wait for the last rank.
    const auto piece = [&] {
      return all.take(std::max<std::uint64_t>(1, all.left() / (3 * static_cast<std::uint64_t>(size_))));
    };
    std::set<int> others;
    for (int rank = 1; rank < size_; ++rank) others.insert(rank);
    bool stopped = false;
    for (bool closed = false;;) {
      const WorkQueue::State own = queue.state(!closed);
      if (!closed && own.empty) {
        const auto more = piece();
        queue.put(more);
        closed = !more;
      }
      if (const int signal = interrupt().signal(); signal != 0 && !std::exchange(stopped, true))
        for (const int rank : others)
          send({.kind = Kind::stop, .signal = static_cast<std::uint64_t>(signal)}, rank, from_leader);
      for (int rank = sender(MPI_ANY_SOURCE, to_leader); rank >= 0; rank = sender(MPI_ANY_SOURCE, to_leader)) {
        const Message report = receive(rank, to_leader);
        others_took(report.taken);
        if (report.signal != 0) interrupt().note(static_cast<int>(report.signal));
        if (report.kind == Kind::leave) {
          send({.kind = Kind::farewell}, rank, from_leader);
          others.erase(rank);
        } else if (report.kind == Kind::piece) {
          const auto more = piece();
          send({.kind = more ? Kind::work : Kind::no_more, .jobs = more.value_or(JobRange())}, rank, from_leader);
        }
      }
      if (own.done && others.empty()) return;
    }
  }

  void follow(WorkQueue& queue) const {
    bool requested = false, notified = false;  // no more is requested after the last piece
    std::uint64_t reported = 0;
    auto last = std::chrono::steady_clock::now();
    for (bool done = false; !done;) {
      const WorkQueue::State own = queue.state(!requested);
      done = own.done;
      Message report{.taken = own.taken - reported};
      if (done)
        report.kind = Kind::leave;
      else if (!requested && own.empty)
        report.kind = Kind::piece, requested = true;
      if (interrupt().signal() != 0 && !std::exchange(notified, true))
        report.signal = static_cast<std::uint64_t>(interrupt().signal());
      const auto now = std::chrono::steady_clock::now();
      if (report.kind != Kind::nothing || report.signal != 0 || (report.taken > 0 && now - last > 500ms)) {
        send(report, 0, to_leader);
        reported += report.taken;
        last = now;
      }
      while (!done && sender(0, from_leader) == 0) {
        const Message reply = receive(0, from_leader);
        requested = reply.kind != Kind::work;
        queue.put(requested ? std::nullopt : std::optional(reply.jobs));
        if (reply.kind == Kind::stop) interrupt().note(static_cast<int>(reply.signal));
      }
    }
    for (Message reply; reply.kind != Kind::farewell; reply = receive(0, from_leader))  // after earlier replies
      wait([] { return sender(0, from_leader) == 0; });
  }

  // Ends the job if a step of one rank throws: other ranks, which may wait for it, are ended by the launcher. Their
  // replicas are in their journals.
  template <class Step> void or_abandon(Step step) const {
    const auto abandon = [this](Exit status) {
      fmt::print(stderr, "cradle: rank {}: {}\n", rank_, message_of_exception());
      std::fflush(stderr);
      std::this_thread::sleep_for(500ms);  // else Open MPI 5 may discard the message
      MPI_Abort(MPI_COMM_WORLD, static_cast<int>(status));
    };
    try {
      step();
    } catch (const Error& error) {
      abandon(error.status);
    } catch (...) {
      abandon(Exit::bad_input);
    }
  }

  int rank_ = 0, size_ = 1;
  unsigned threads_ = 0;
};

}  // namespace

std::unique_ptr<Processes> make_mpi_processes(int processes_launched, Interrupt& interrupt) {
  return std::make_unique<MpiProcesses>(processes_launched, interrupt);
}

}  // namespace cradle::tools
