#include "cradle/tools/store/journal.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "cradle/tools/support/checksum.hpp"
#include "cradle/tools/support/errors.hpp"
#include "cradle/tools/support/version.hpp"

namespace cradle::tools {

namespace {

constexpr std::array<std::string_view, 2> begins{"CRADLEJ3", "CRADLER2"};  // by JournalOf
constexpr std::array<std::string_view, 3> begins_of_version_1{"CRADLEJ1", "CRADLEJ2", "CRADLER1"};
constexpr std::size_t begin_size = 8;

std::string_view begin_of(JournalOf kind) { return begins[static_cast<std::size_t>(kind)]; }
constexpr std::uint64_t frame = 16;  // bytes of a record beside itself

[[noreturn]] void fail_journal(const std::string& path, const char* what) {
  throw Error({path, 0, ""}, what, std::strerror(errno), "check the folder and the space on its disk", Exit::io);
}

std::string_view as_bytes(const std::uint64_t& number) {
  return {reinterpret_cast<const char*>(&number), sizeof number};
}

std::uint64_t checksum(std::uint64_t length, std::string_view record) { return crc64(record, crc64(as_bytes(length))); }

// Length, record, checksum of both; returns how many bytes that is.
std::uint64_t write_record(int file, std::string_view record, const std::string& path) {
  const std::uint64_t length = record.size(), check = checksum(length, record);
  write_all(file, {as_bytes(length), record, as_bytes(check)}, path);
  return length + frame;
}

}  // namespace

// ---- reading

std::optional<JournalOf> JournalReader::kind(const std::string& path) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(path, none)) return {};  // a FIFO would make us wait for ever
  std::ifstream file(path, std::ios::binary);
  std::string begin(begin_size, '\0');
  if (!file.read(begin.data(), begin_size)) return {};
  if (std::find(begins_of_version_1.begin(), begins_of_version_1.end(), begin) != begins_of_version_1.end())
    throw of_version(path, 1);
  const auto found = std::find(begins.begin(), begins.end(), begin);
  if (found == begins.end()) return {};
  return static_cast<JournalOf>(found - begins.begin());
}

JournalReader::JournalReader(const std::string& path, JournalOf kind) : path_(path) {
  const auto found = JournalReader::kind(path);
  if (found && found != kind)
    throw Error({path, 0, ""}, "another kind of journal", *found == JournalOf::run ? "of a run" : "of an ensemble",
                "continue it by `cradle resume`, or give another -o FILE", Exit::io);
  if (found) file_.open(path, std::ios::binary);
  if (found && !file_) fail_journal(path, "the journal could not be read");
  if (found) {
    size_ = std::filesystem::file_size(path);
    file_.seekg(begin_size);
    whole_ = begin_size;
  }
  if (!found || !next(header_))
    throw Error({path, 0, ""}, "not a journal of this version of the program, or its beginning is damaged", "",
                "take it from a copy, or remove it", Exit::io);
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

// ---- writing

JournalWriter::JournalWriter(const std::string& path, JournalOf kind, std::string_view header,
                             const std::function<void(const Put&)>& records, Sync sync)
    : path_(path) {
  NewFile file(path);
  claim(file.descriptor());
  const auto put = [&](std::string_view record) { bytes_ += write_record(file.descriptor(), record, path); };
  file.write({begin_of(kind)});
  bytes_ = begin_size;
  put(header);
  if (records) records(put);
  file_ = file.put_in_place_open(sync);
}

JournalWriter::JournalWriter(const std::string& path)
    : path_(path), file_(::open(file_behind(path).c_str(), O_WRONLY | O_CLOEXEC)) {
  if (file_ < 0) fail_journal(path, "the journal could not be opened");
  claim(file_);
}

void JournalWriter::continue_after(std::uint64_t whole_bytes) {
  if (::ftruncate(file_, static_cast<off_t>(whole_bytes)) != 0 || ::lseek(file_, 0, SEEK_END) < 0)
    fail_journal(path_, "the journal could not be continued");
  bytes_ = whole_bytes;
}

// Two programs on one journal would spoil it. File systems that cannot lock are taken at their word.
void JournalWriter::claim(int file) const {
  if (::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw Error({path_, 0, ""}, "another program is writing this journal", "", "wait for it, or give another -o FILE",
                Exit::io);
}

void JournalWriter::append(std::string_view record) {
  try {
    bytes_ += write_record(file_, record, path_);
  } catch (const Error&) {
    continue_after(bytes_);  // what comes after half a record could not be read
    throw;
  }
}

void JournalWriter::sync() const { sync_file(file_, path_); }

}  // namespace cradle::tools
