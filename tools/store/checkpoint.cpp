#include "cradle/tools/store/checkpoint.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "cradle/tools/support/bytes.hpp"
#include "cradle/tools/support/version.hpp"

namespace cradle::tools {

namespace {

constexpr std::string_view begin = begin_of(Stored::checkpoint);

}  // namespace

// ---- writing

StateWriter::StateWriter(const std::string& path, const CheckpointHeader& header) : file_(path) {
  buffer_.reserve(buffer_size);
  put(begin.data(), begin.size());
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

// ---- reading

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
  constexpr std::uint64_t frame = begin.size() + sizeof(std::uint64_t);
  const std::uint64_t size = std::filesystem::file_size(path);
  if (size < frame) throw damaged("too short");
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
  if (!std::string_view(buffer_).starts_with(begin)) throw damaged("of another kind");
  at_ = begin.size();
  try {
    std::string program;
    load(*this, program);
    check_program(program, path);
    load(*this, header_);
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
