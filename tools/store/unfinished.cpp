#include "cradle/tools/store/unfinished.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "cradle/tools/support/bytes.hpp"
#include "cradle/tools/support/errors.hpp"
#include "cradle/tools/support/version.hpp"

namespace cradle::tools {

namespace {

constexpr std::uint64_t format = 4;  // of journals and checkpoints: the last character of their first bytes
constexpr std::size_t begin_size = 8;
constexpr std::uint64_t frame = 16;  // bytes that a record takes besides its contents

[[noreturn]] void fail_journal(const std::string& path, const char* what) {
  throw Error({path}, what, std::strerror(errno), "check the folder and the space on its disk", Exit::io);
}

std::uint64_t checksum(std::uint64_t length, std::string_view record) { return crc64(record, crc64(to_bytes(length))); }

// Writes length, record and the checksum of both; returns the number of bytes.
std::uint64_t write_record(int file, std::string_view record, const std::string& path) {
  const std::uint64_t length = record.size();
  write_all(file, {to_bytes(length), record, to_bytes(checksum(length, record))}, path);
  return length + frame;
}

// Loads the header of a journal or a checkpoint. Throws Error (Exit::io) unless this version of the program wrote it.
template <class From, class Header> void load_header(From& from, Header& header, const std::string& path) {
  std::string program;
  load(from, program);
  if (program != version)
    throw Error({path}, "of another version of the program", fmt::format("{}, here {}", program, version),
                "continue with that one, or remove the file: its scene then starts anew", Exit::io);
  load(from, header);
}

}  // namespace

// ---- journals

Stored stored_in(const std::string& path) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(path, none)) return Stored::other;  // opening a FIFO would wait for ever
  std::ifstream file(path, std::ios::binary);
  std::string begin(begin_size, '\0');
  if (!file.read(begin.data(), begin_size)) return Stored::other;
  for (const Stored kind : {Stored::journal, Stored::checkpoint})
    if (begin == begin_of(kind)) return kind;
  const auto digit = static_cast<std::uint64_t>(begin.back() - '0');
  // Earlier formats; R was the journal of a run.
  const bool ours = begin.starts_with("CRADLEJ") || begin.starts_with("CRADLER") || begin.starts_with("CRADLEC");
  if (ours && digit < 10) throw of_version(path, digit, format);
  return Stored::other;
}

JournalReader::JournalReader(const std::string& path) : path_(path) {
  std::string record;
  if (stored_in(path) == Stored::journal) {
    file_.open(path, std::ios::binary);
    if (!file_) fail_journal(path, "the journal could not be read");
    size_ = std::filesystem::file_size(path);
    file_.seekg(begin_size);
    whole_ = begin_size;
  }
  if (!file_.is_open() || !next(record))
    throw Error({path}, "not a journal of this version of the program, or its beginning is damaged", "",
                "take it from a copy, or remove it", Exit::io);
  try {
    SavedState from(std::move(record));
    load_header(from, header_, path);
  } catch (const std::invalid_argument& error) {
    throw Error({path}, "a damaged journal", error.what(), "take it from a copy, or remove it", Exit::io);
  }
}

bool JournalReader::next(std::string& record) {
  const auto read = [&](char* to, std::uint64_t size) {
    return static_cast<bool>(file_.read(to, static_cast<std::streamsize>(size)));
  };
  std::uint64_t length = 0, check = 0;
  if (size_ - whole_ < frame || !read(reinterpret_cast<char*>(&length), 8) || length > size_ - whole_ - frame)
    return false;
  record.resize(length);
  if (!read(record.data(), length) || !read(reinterpret_cast<char*>(&check), 8) || check != checksum(length, record))
    return false;
  whole_ += length + frame;
  return true;
}

std::optional<JournalHeader> journal_header(const std::string& path) {
  if (stored_in(path) != Stored::journal) return {};
  return JournalReader(path).header();
}

JournalWriter::JournalWriter(const std::string& path, const JournalHeader& header,
                             const std::function<void(const Put&)>& records, Sync sync)
    : path_(path) {
  NewFile file(path);
  const auto put = [&](std::string_view record) { bytes_ += write_record(file.descriptor(), record, path); };
  file.write({begin_of(Stored::journal)});
  bytes_ = begin_size;
  put(to_bytes(std::string(version)) + to_bytes(header));
  if (records) records(put);
  file_ = file.put_in_place_open(sync);
}

JournalWriter::JournalWriter(const std::string& path, std::uint64_t whole_bytes)
    : path_(path), file_(::open(file_behind(path).c_str(), O_WRONLY | O_CLOEXEC)) {
  if (file_ < 0) fail_journal(path, "the journal could not be opened");
  cut(whole_bytes);
}

void JournalWriter::cut(std::uint64_t bytes) {
  if (::ftruncate(file_, static_cast<off_t>(bytes)) != 0 || ::lseek(file_, 0, SEEK_END) < 0)
    fail_journal(path_, "the journal could not be continued");
  bytes_ = bytes;
}

void JournalWriter::append(std::string_view record) {
  try {
    bytes_ += write_record(file_, record, path_);
  } catch (const Error&) {
    cut(bytes_);  // records after an incomplete one could not be read
    throw;
  }
}

void JournalWriter::sync() const { sync_file(file_, path_); }

// ---- checkpoints

StateWriter::StateWriter(const std::string& path, const CheckpointHeader& header) : file_(path) {
  buffer_.reserve(buffer_size);
  put(begin_of(Stored::checkpoint).data(), begin_size);
  save(*this, std::string(version));
  save(*this, header);
}

void StateWriter::flush() {
  check_ = crc64(buffer_, check_);
  file_.write({buffer_});
  buffer_.clear();
}

void StateWriter::finish() {
  flush();
  file_.write({to_bytes(check_)});
  file_.put_in_place();
}

Error StateReader::damaged(const std::string& what) const {
  const bool own = path_.ends_with(".checkpoint");  // else a file that somebody gave, perhaps a result
  return {{path_},
          "not a checkpoint, or damaged",
          what,
          own ? "remove it: the run then starts anew" : "give a checkpoint",
          Exit::io};
}

StateReader::StateReader(const std::string& path) : path_(path) {
  stored_in(path);  // throws for other formats
  if (!instead_of_file(path).empty()) throw damaged("no file");
  file_.open(path, std::ios::binary);
  if (!file_) throw Error({path}, "could not be read", std::strerror(errno), "check its name and rights", Exit::io);
  const std::uint64_t size = std::filesystem::file_size(path);
  if (size < begin_size + sizeof(std::uint64_t)) throw damaged("too short");
  std::uint64_t check = 0;
  for (after_buffer_ = size - sizeof check; after_buffer_ > 0;) {
    fill();
    check = crc64(buffer_, check);
  }
  std::uint64_t wanted = 0;
  if (!file_.read(reinterpret_cast<char*>(&wanted), sizeof wanted) || wanted != check)
    throw damaged("its checksum is wrong");
  file_.seekg(0);
  after_buffer_ = size - sizeof check;
  fill();
  if (!std::string_view(buffer_).starts_with(begin_of(Stored::checkpoint))) throw damaged("of another kind");
  at_ = begin_size;
  try {
    load_header(*this, header_, path);
  } catch (const std::invalid_argument& error) {
    throw damaged(error.what());
  }
}

void StateReader::fill() {
  constexpr std::uint64_t at_once = std::uint64_t{1} << 18;
  buffer_.resize(std::min(after_buffer_, at_once));
  if (!file_.read(buffer_.data(), static_cast<std::streamsize>(buffer_.size()))) throw damaged("it has become shorter");
  after_buffer_ -= buffer_.size();
  at_ = 0;
}

void StateReader::get_slowly(char* data, std::size_t size) {
  if (size > left()) throw damaged("it ends too early");
  while (size > 0) {
    if (at_ == buffer_.size()) fill();
    const std::size_t now = std::min(size, buffer_.size() - at_);
    std::memcpy(data, buffer_.data() + at_, now);
    at_ += now;
    data += now;
    size -= now;
  }
}

void StateReader::end() const {
  if (left() > 0) throw damaged("it holds more than a state");
}

}  // namespace cradle::tools
