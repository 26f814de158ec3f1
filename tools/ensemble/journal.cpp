#include "cradle/tools/ensemble/journal.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/uio.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "cradle/tools/ensemble/checksum.hpp"

namespace cradle::tools {

namespace {

constexpr std::string_view magic = "CRADLEJ1";

[[noreturn]] void fail(const std::string& path, const char* what) {
  throw Error({path, 0, ""}, what, std::strerror(errno), "check the folder and the space on its disk", Exit::io);
}

std::string_view as_bytes(const std::uint64_t& number) {
  return {reinterpret_cast<const char*>(&number), sizeof number};
}

std::uint64_t checksum(std::uint64_t length, std::string_view record) { return crc64(record, crc64(as_bytes(length))); }

}  // namespace

// ---- reading

bool JournalReader::is_journal(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string begin(magic.size(), '\0');
  return file.read(begin.data(), static_cast<std::streamsize>(begin.size())) && begin == magic;
}

JournalReader::JournalReader(const std::string& path) : path_(path), file_(path, std::ios::binary) {
  if (!file_) fail(path, "the journal could not be read");
  size_ = std::filesystem::file_size(path);
  file_.seekg(static_cast<std::streamoff>(magic.size()));
  whole_ = magic.size();
  if (!is_journal(path) || !next(header_))
    throw Error({path, 0, ""}, "not a journal of this program, or its beginning is damaged", "", "remove it", Exit::io);
}

bool JournalReader::next(std::string& record) {
  const auto read = [&](char* to, std::uint64_t size) {
    return static_cast<bool>(file_.read(to, static_cast<std::streamsize>(size)));
  };
  std::uint64_t length = 0, check = 0;
  if (size_ - whole_ < 16 || !read(reinterpret_cast<char*>(&length), 8) || length > size_ - whole_ - 16) return false;
  record.resize(length);
  if (!read(record.data(), length) || !read(reinterpret_cast<char*>(&check), 8) || check != checksum(length, record))
    return false;
  whole_ += length + 16;
  return true;
}

// ---- writing

JournalWriter::File::~File() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

JournalWriter::JournalWriter(const std::string& path, std::string_view header,
                             const std::function<void(const Put&)>& records)
    : path_(path), file_(::open((path + ".new").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666)) {
  const std::string temporary = path + ".new";
  if (file_ < 0) fail(path, "the journal could not be created");
  claim();
  if (::ftruncate(file_, 0) != 0) fail(path, "the journal could not be created");
  write({magic});
  append(header);
  if (records) records([this](std::string_view record) { append(record); });
  sync();
  if (std::rename(temporary.c_str(), path.c_str()) != 0) fail(path, "the journal could not be put in place");
}

JournalWriter::JournalWriter(const std::string& path) : path_(path), file_(::open(path.c_str(), O_WRONLY | O_CLOEXEC)) {
  if (file_ < 0) fail(path, "the journal could not be opened");
  claim();
}

void JournalWriter::go_on_after(std::uint64_t whole_bytes) {
  if (::ftruncate(file_, static_cast<off_t>(whole_bytes)) != 0 || ::lseek(file_, 0, SEEK_END) < 0)
    fail(path_, "the journal could not be continued");
  bytes_ = whole_bytes;
}

// Two programs on one journal would spoil it. File systems that cannot lock are taken at their word.
void JournalWriter::claim() const {
  if (::flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw Error({path_, 0, ""}, "another program is writing this journal", "", "wait for it, or give another -o FILE",
                Exit::io);
}

// length, record, checksum of both
void JournalWriter::append(std::string_view record) {
  const std::uint64_t length = record.size(), check = checksum(length, record);
  write({as_bytes(length), record, as_bytes(check)});
}

void JournalWriter::write(std::array<std::string_view, 3> parts) {
  for (std::size_t first = 0; first < parts.size();) {
    std::array<iovec, 3> left{};
    for (std::size_t k = first; k < parts.size(); ++k)
      left[k - first] = {const_cast<char*>(parts[k].data()), parts[k].size()};
    ssize_t written = ::writev(file_, left.data(), static_cast<int>(parts.size() - first));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path_, "the journal could not be written");
    bytes_ += static_cast<std::uint64_t>(written);
    for (; first < parts.size() && static_cast<std::size_t>(written) >= parts[first].size(); ++first)
      written -= static_cast<ssize_t>(parts[first].size());
    if (first < parts.size()) parts[first].remove_prefix(static_cast<std::size_t>(written));
  }
}

void JournalWriter::sync() const {
#if defined(_POSIX_SYNCHRONIZED_IO) && _POSIX_SYNCHRONIZED_IO > 0
  const int status = ::fdatasync(file_);
#else
  const int status = ::fsync(file_);
#endif
  if (status != 0 && errno != EINVAL) fail(path_, "the journal could not be written");
}

}  // namespace cradle::tools
