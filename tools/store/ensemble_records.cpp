// An ensemble as records. Each begins with the point that it belongs to and what it is.
#include "cradle/tools/ensemble/state.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace cradle::tools {

namespace {

enum class Kind : std::uint64_t { replica = 1, failed, rows, spread, node };

ByteWriter begin(std::uint64_t point, Kind kind) {
  ByteWriter bytes;
  bytes.put(point).put(static_cast<std::uint64_t>(kind));
  return bytes;
}

void put(ByteWriter& bytes, const ReplicaRow& row) {
  bytes.put(row.index)
      .put(static_cast<std::uint64_t>(row.outcome))
      .put(row.collisions)
      .put(row.merges)
      .put(row.numbers);
}

Error damaged(const std::string& found) {
  return Error({"a journal", 0, ""}, "a damaged ensemble", found, "take it from a copy, or run it again", Exit::io);
}

ReplicaIndex read_index(ByteReader& bytes) {
  const ReplicaIndex index = bytes.integer();
  if (index >> 63) throw damaged(fmt::format("replica {}", index));  // the tree ends there
  return index;
}

ReplicaRow read_row(ByteReader& bytes) {
  ReplicaRow row;
  row.index = read_index(bytes);
  row.outcome = static_cast<RunEnd>(std::min<std::uint64_t>(bytes.integer(), outcome_count - 1));
  row.collisions = bytes.integer();
  row.merges = bytes.integer();
  row.numbers = bytes.numbers<double>();
  return row;
}

}  // namespace

std::string EnsembleState::record(std::uint64_t point, const ReplicaRow& row, const std::vector<double>& values) {
  ByteWriter bytes = begin(point, Kind::replica);
  bytes.reserve((16 + row.numbers.size() + values.size()) * sizeof(double));
  put(bytes, row);
  bytes.put(values);
  return std::move(bytes).bytes();
}

std::string EnsembleState::record(std::uint64_t point, ReplicaIndex failed, const std::string& message) {
  return begin(point, Kind::failed).put(failed).put(message).bytes();
}

void EnsembleState::put_records(std::uint64_t point, const JournalWriter::Put& put_record) const {
  constexpr std::size_t rows_of_a_record = 10000;
  for (std::size_t first = 0; first < table_.size(); first += rows_of_a_record) {
    const std::size_t last = std::min(first + rows_of_a_record, table_.size());
    ByteWriter bytes = begin(point, Kind::rows);
    bytes.put(std::uint64_t{last - first});
    for (std::size_t k = first; k < last; ++k) {
      const ReplicaRow row = table_[k];
      put(bytes, row);
      const auto failure = messages_.find(row.index);
      bytes.put(failure == messages_.end() ? std::string_view() : std::string_view(failure->second));
    }
    put_record(bytes.bytes());
  }
  for (std::size_t k = 0; k < spreads_.size(); ++k)
    put_record(begin(point, Kind::spread).put(std::uint64_t{k}).put(spreads_[k].all_counts()).bytes());
  for (const TreeNode& node : tree_.nodes()) {
    const Moments& m = node.moments;
    put_record(begin(point, Kind::node)
                   .put(node.first)
                   .put(std::uint64_t{node.level})
                   .put(m.replicas)
                   .put(m.mean)
                   .put(m.squares)
                   .put(m.least)
                   .put(m.greatest)
                   .put(m.counts)
                   .bytes());
  }
}

std::uint64_t EnsembleState::replicas_in(std::string_view record) {
  ByteReader bytes(record);
  bytes.integer();  // the point
  switch (static_cast<Kind>(bytes.integer())) {
  case Kind::replica:
  case Kind::failed:
    return 1;
  case Kind::rows:
    return bytes.integer();
  default:
    return 0;
  }
}

void EnsembleState::apply(std::string_view record) {
  ByteReader bytes(record);
  bytes.integer();  // the point
  switch (static_cast<Kind>(bytes.integer())) {
  case Kind::replica: {
    const ReplicaRow row = read_row(bytes);
    if (!tree_.contains(row.index)) add(row, bytes.numbers<double>());
    return;
  }
  case Kind::failed: {
    const ReplicaIndex replica = read_index(bytes);
    if (!tree_.contains(replica)) fail(replica, bytes.text());
    return;
  }
  case Kind::rows:
    for (std::uint64_t left = bytes.integer(); left > 0; --left) {
      const ReplicaRow row = read_row(bytes);
      table_.add(row);
      std::string message = bytes.text();
      if (row.outcome == RunEnd::failed) messages_.emplace(row.index, std::move(message));
    }
    return;
  case Kind::spread: {
    const std::uint64_t k = bytes.integer();
    std::vector<std::uint64_t> counts = bytes.numbers<std::uint64_t>();
    if (k >= spreads_.size() || counts.size() != spreads_[k].all_counts().size())
      throw damaged(fmt::format("{} counts for the spread {}", counts.size(), k));
    Histograms other(spreads_[k].bins(), spreads_[k].entries());
    other.set_all_counts(std::move(counts));
    spreads_[k].add(other);
    return;
  }
  case Kind::node: {
    TreeNode node{bytes.integer(), level_of(bytes.integer()), {}};
    Moments& m = node.moments;
    m.replicas = bytes.integer();
    m.mean = bytes.numbers<double>();
    m.squares = bytes.numbers<double>();
    m.least = bytes.numbers<double>();
    m.greatest = bytes.numbers<double>();
    m.counts = bytes.numbers<std::uint64_t>();
    take_node(std::move(node), "a journal");
    return;
  }
  }
  throw Error({}, "a record that this version does not know", "", "use the program that wrote it", Exit::io);
}

}  // namespace cradle::tools
