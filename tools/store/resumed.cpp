// Finds what a stopped run continues from: its journal and its checkpoint, or its result and the checkpoint of its end.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "cradle/tools/record/schedule.hpp"
#include "cradle/tools/result/files.hpp"
#include "cradle/tools/result/result.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/store/run_files.hpp"
#include "cradle/tools/support/bytes.hpp"

namespace cradle::tools {

namespace {

bool exists(const std::string& path) {
  std::error_code none;
  return std::filesystem::exists(path, none);
}

// The length of a journal up to and including this number of records; nothing if it has fewer complete records.
std::optional<std::uint64_t> end_of_records(const std::string& path, std::uint64_t records, std::uint64_t& check,
                                            const JournalWriter::Put& put = {}) {
  JournalReader reader(path);
  check = 0;
  std::string record;
  for (std::uint64_t k = 0; k < records; ++k) {
    if (!reader.next(record)) return {};
    check = crc64(record);
    if (put) put(record);
  }
  return reader.whole_bytes();
}

// The same run with a later end; its samples are spaced as before.
Scene extended(Scene scene, const std::string& until, const std::string& file) {
  const Decimal later(until);
  if (later < scene.run.until)
    throw Error({"--until", 0, ""}, "before the end of the run that is there", until,
                fmt::format("give a time after {}", scene.run.until.text));
  for (const MeasurementRow* row : measurement_rows())
    if (row->until_end != nullptr && row->wanted(scene))
      throw Error({file, 0, row->until_end}, "an average up to run.until cannot be extended", scene.run.until.text,
                  "run the scene anew with a later run.until");
  Series& series = scene.output.series;
  if (series.points && !series.over && scene.run.start < scene.run.until) series.over = scene.run.until;
  scene.run.until = later;
  try {
    return parse_scene(effective_toml(scene), file);  // as a scene with that end is read
  } catch (const Error&) {                            // which was valid with its own end
    throw Error({"--until", 0, ""}, "too late for this run, whose precision and spacing of samples stay", until,
                "give an earlier time, or run the scene anew with this run.until");
  }
}

// Lists of times are not extended: of a run that was cut short by --set run.until they have lost the times of the scene
// that came later. Of a bundled scene these are known; of another one, snapshots that end before the run may have been
// cut off. (If there are none, as a rule there were none.) Nor is what is measured from samples whose number is given.
std::string kept_with_a_later_end(const Scene& scene, const Decimal& later) {
  const auto bundled = bundled_scenes();
  const auto at = std::find_if(bundled.begin(), bundled.end(),
                               [&](const auto& b) { return b.name.substr(b.name.rfind('/') + 1) == scene.name; });
  const std::optional<Scene> original =
      at == bundled.end() ? std::nullopt : std::optional(parse_scene(at->text, scene.name + ".toml"));
  const auto lost = [&](const std::vector<Decimal>& times) {
    return std::any_of(times.begin(), times.end(),
                       [&](const Decimal& t) { return t > scene.run.until && !(t > later); });
  };
  std::string keys;
  const auto check = [&](const char* key, bool cut) {
    keys += cut ? (keys.empty() ? "" : ", ") + std::string(key) : "";
  };
  const std::vector<Decimal>& snapshots = scene.output.snapshots;
  if (original) {
    for (const MeasurementRow* row : measurement_rows())
      if (row->times) check(row->key, lost(row->times(original->output)));
  } else {
    check("output.snapshots", !snapshots.empty() && snapshots.back() < scene.run.until);
  }
  std::string said;
  if (!keys.empty())
    said = fmt::format("lists of times are not extended beyond t = {} ({}): to have later times of the scene, run it "
                       "with --set run.until={}\n",
                       scene.run.until.text, keys, later.text);
  keys.clear();
  const Output& o = scene.output;
  const std::pair<const char*, const Samples*> windows[] = {{"output.averages", &o.averages},
                                                            {"output.counting", &o.counting},
                                                            {"output.correlations", &o.correlations},
                                                            {"output.structure", &o.structure},
                                                            {"output.pair_distribution", &o.pair_distribution}};
  for (const auto& [key, samples] : windows)
    check(key,
          samples->until == scene.run.until && (samples->every || (samples == &o.counting && !o.histograms.empty())));
  if (!keys.empty())
    said += fmt::format("what is measured up to t = {} stays so ({}): for a later end of it, run the scene anew\n",
                        scene.run.until.text, keys);
  return said;
}

// Without an observer of collisions the sticky gas is computed directly at each time, and its rounding depends on these
// times. With other times it starts again, which costs almost nothing.
bool begins_again(const Scene& scene) { return without_collisions(scene); }

// The rows in a result file, without the tables that summarise the whole run.
std::vector<Group> recorded(std::vector<Group> groups, const Scene& scene) {
  std::erase_if(groups, [](const Group& g) {
    const std::string_view name = rounded_name(g.name), folder = name.substr(0, name.find('/'));
    const auto rows = measurement_rows();
    return name == "collapse" || std::ranges::find(rows, folder, &MeasurementRow::at_end) != rows.end();
  });
  // The file returns attributes in another order than they were written.
  const auto rank = [](const Attribute& attribute) {
    constexpr std::array<std::string_view, 3> first{"time", "gap_min", "gap_median"};
    return std::find(first.begin(), first.end(), attribute.first) - first.begin();
  };
  for (Group& table : groups)
    std::stable_sort(table.attributes.begin(), table.attributes.end(),
                     [&](const Attribute& a, const Attribute& b) { return rank(a) < rank(b); });
  // Removes a sample at the end that is there only because the run ended.
  const std::vector<double> planned = Schedule(scene).series().rounded();
  const auto one_too_many = [&](const Group& table) {
    if (table.name != "series" || table.columns.empty()) return false;
    const auto* taken = std::get_if<std::vector<double>>(&table.columns.front().values);
    return taken != nullptr && !taken->empty() && !std::binary_search(planned.begin(), planned.end(), taken->back());
  };
  if (std::any_of(groups.begin(), groups.end(), one_too_many))
    for (Group& table : groups)
      for (Column& column : table.columns)
        if (rounded_name(table.name).starts_with("series"))
          std::visit([&](auto& v) { v.resize(v.size() - std::min(v.size(), column.width)); }, column.values);
  return groups;
}

}  // namespace

RunFiles::RunFiles(std::string file, const std::optional<std::string>& until)
    : Sink(Tables::for_file), file_(std::move(file)) {
  if (exists(journal_of(file_)))
    resume(until);
  else
    resume_from_result(until);
  started_ = reported_ = saved_ = Clock::now();
}

// ---- resuming

void RunFiles::resume(const std::optional<std::string>& until) {
  const std::string path = journal_of(file_), state = checkpoint_of(file_);
  header_ = JournalReader(path).header();
  scene_ = scene_of(header_, path);
  if (exists(state)) state_ = std::make_unique<StateReader>(state);
  if (state_ && state_->header().run.identity != header_.identity) state_.reset();  // of an earlier run
  // An extension that has no checkpoint yet starts again from the result.
  if (!state_ && header_.extends) return resume_from_result(until ? *until : scene_.run.until.text);
  const CheckpointHeader found = state_ ? state_->header() : CheckpointHeader();
  const bool later = until && Decimal(*until) != scene_.run.until;
  if (later && state_ && !(found.time < scene_.run.until.value))
    throw Error({file_}, "not written yet", "the run has reached its end",
                fmt::format("finish it first: `cradle resume {}`", file_));
  if (later && begins_again(scene_)) {
    state_.reset();
    ++header_.identity;  // the checkpoint then belongs to another identity
  }
  if (later) extend(*until, path);
  records_ = state_ ? found.records : 0;
  std::uint64_t end = 0;
  const auto read = [&](const JournalWriter::Put& put) {
    const auto there = end_of_records(path, records_, check_, put);
    if (!there || (state_ && check_ != found.check))
      throw Error({path}, "damaged before its checkpoint",
                  fmt::format("other records than the {} that were there", records_),
                  "take it from a copy, or remove it: the run then starts anew", Exit::io);
    end = *there;
  };
  if (later) {
    journal_.emplace(path, header_, read);
  } else {
    read({});
    journal_.emplace(path, end);
  }
  if (state_) from(found);
}

void RunFiles::resume_from_result(const std::optional<std::string>& until) {
  if (!exists(file_))
    throw Error({file_}, "nothing to continue from", "neither a result nor a journal", "run the scene", Exit::io);
  Result result = read_result(file_, Reading::ends);
  scene_ = scene_in(result.attributes, file_);
  if (const std::string command = command_of(result); until && command != "run")
    throw Error({"--until", 0, ""},
                fmt::format("a result of {} has no later end", command.substr(0, command.find(' '))), *until,
                "repeat that command with a later run.until and a file of its own (-o)");
  const auto& outcome = attribute<std::string>(result.attributes, "outcome", file_);
  if (!until || Decimal(*until) == scene_.run.until || outcome != end_row(RunEnd::reached).text) {
    over_ =
        fmt::format("{}: nothing to do, the run is over: {}, run.until = {}", file_, outcome, scene_.run.until.text);
    over_status_ = status_of_text(outcome);
    return;
  }
  header_ = {"run", drawn_number(), "", scene_.name};
  header_.extends = true;
  // A run that ended before its journal began has left no checkpoint, and is computed again from the start.
  if (const std::string state = checkpoint_of(file_); exists(state)) {
    state_ = std::make_unique<StateReader>(state);
    const CheckpointHeader& found = state_->header();
    header_.every_seconds = found.run.every_seconds;
    if (found.run.scene != effective_toml(scene_) || found.time != scene_.run.until.value)
      throw Error({state}, "not the end of this run", fmt::format("t = {:.10g}", found.time),
                  "run the scene with a later run.until", Exit::io);
    if (begins_again(scene_)) state_.reset();
  }
  if (const std::uint64_t numbers = numbers_in(result.groups); state_ && numbers > most_in_memory)
    throw Error({file_}, "too large to be extended", fmt::format("{} numbers", numbers),
                "run the scene with a later run.until", Exit::io);
  extend(*until, file_);
  if (!state_) return;
  for (Group& rows : recorded(read_result(file_).groups, scene_)) waiting_.add(std::move(rows));
  from(state_->header());
}

void RunFiles::extend(const std::string& until, const std::string& path) {
  not_extended_ = kept_with_a_later_end(scene_, Decimal(until));
  scene_ = extended(scene_, until, path);
  scene_.name = header_.name;
  header_.scene = effective_toml(scene_);
}

void RunFiles::from(const CheckpointHeader& found) {
  from_ = fmt::format("t = {:.10g}, {} collisions", found.time, found.collisions);
  seconds_before_ = found.seconds;
  collisions_before_ = found.collisions;
}

}  // namespace cradle::tools
