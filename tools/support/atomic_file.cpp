#include "cradle/tools/support/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

namespace {

namespace fs = std::filesystem;

constexpr const char* make_room = "check the folder and the space on its disk";

[[noreturn]] void fail(const std::string& path, const char* what, const char* advice = make_room) {
  throw Error({path}, what, std::strerror(errno), advice, Exit::io);
}

std::string folder_of(const std::string& path) {
  const std::string folder = fs::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

// ".NAME.ending" in the folder of the file.
std::string hidden_beside(const std::string& path, const std::string& ending) {
  return (fs::path(path).parent_path() / ("." + fs::path(path).filename().string() + ending)).string();
}

// What is there in place of a file; empty for a file and where there is nothing.
std::string_view instead_of_file(const fs::file_status& found) {
  const fs::file_type type = found.type();
  if (!fs::exists(found) || type == fs::file_type::regular || type == fs::file_type::unknown) return {};
  return type == fs::file_type::directory ? "a folder of that name"
         : type == fs::file_type::fifo    ? "a FIFO"
         : type == fs::file_type::socket  ? "a socket"
                                          : "a device";
}

bool same_file(int descriptor, const std::string& name) {
  using Status = struct stat;
  Status open{}, named{};
  return ::fstat(descriptor, &open) == 0 && ::lstat(name.c_str(), &named) == 0 && open.st_ino == named.st_ino &&
         open.st_dev == named.st_dev;
}

// The owner named in a lock file.
std::string owner(int lock) {
  std::array<char, 200> text{};
  const ssize_t size = ::pread(lock, text.data(), text.size(), 0);
  return {text.data(), size > 0 ? static_cast<std::size_t>(size) : 0};
}

void write_owner(int lock) {
  std::array<char, 100> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) return;
  const std::string text = fmt::format("process {} on {}", ::getpid(), host.data());
  // Names the owner, for the message of a program that is refused.
  if (::ftruncate(lock, 0) == 0) static_cast<void>(::pwrite(lock, text.data(), text.size(), 0) == 0);
}

// Syncs the folder: a name is permanent only when its folder is on the disk. Some folders cannot be opened or synced.
void sync_folder(const std::string& path) {
  const Descriptor folder(::open(folder_of(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder < 0) return;
  sync_file(folder, path);
}

// Removes temporary files for this file, its journal or its checkpoint whose writer was killed.
void remove_leftovers(const std::string& target) {
  const std::string folder = folder_of(target), name = fs::path(target).filename().string();
  std::error_code none;
  for (fs::directory_iterator entry(folder, none), end; !none && entry != end; entry.increment(none)) {
    const std::string found = entry->path().filename().string();
    for (const char* kind : {"", ".part", ".checkpoint"}) {
      const std::string begin = fmt::format(".{}{}.cradle-", name, kind);
      if (!found.starts_with(begin)) continue;
      const long owner = std::atol(found.c_str() + begin.size());
      std::error_code ignored;
      if (owner > 0 && ::kill(static_cast<pid_t>(owner), 0) != 0 && errno == ESRCH) fs::remove(entry->path(), ignored);
    }
  }
}

}  // namespace

Descriptor::~Descriptor() {
  if (number_ >= 0) ::close(number_);
}

std::string file_behind(const std::string& path) {
  fs::path target = path;
  if (!target.has_filename()) target = target.parent_path();
  constexpr int links_at_most = 40;
  for (int links = 0; links <= links_at_most; ++links) {
    std::error_code error;
    const fs::file_status found = fs::symlink_status(target, error);
    if (found.type() == fs::file_type::symlink) {
      target = target.parent_path() / fs::read_symlink(target, error);
      continue;
    }
    if (const std::string_view other = instead_of_file(found); !other.empty())
      throw Error({path}, "cannot be written", other, "give another -o FILE", Exit::io);
    return target.string();
  }
  throw Error({path}, "cannot be written", "links that lead nowhere", "give another -o FILE", Exit::io);
}

std::string_view instead_of_file(const std::string& path) {
  std::error_code error;
  return instead_of_file(fs::status(path, error));
}

void write_all(int descriptor, std::array<std::string_view, 3> parts, const std::string& path) {
  for (std::size_t first = 0; first < parts.size();) {
    std::array<iovec, 3> left{};
    for (std::size_t k = first; k < parts.size(); ++k)
      left[k - first] = {const_cast<char*>(parts[k].data()), parts[k].size()};
    ssize_t written = ::writev(descriptor, left.data(), static_cast<int>(parts.size() - first));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path, "could not be written");
    for (; first < parts.size() && static_cast<std::size_t>(written) >= parts[first].size(); ++first)
      written -= static_cast<ssize_t>(parts[first].size());
    if (first < parts.size()) parts[first].remove_prefix(static_cast<std::size_t>(written));
  }
}

void sync_file(int descriptor, const std::string& path) {
  // Some file systems do not support fsync; that is not an error.
  if (::fsync(descriptor) != 0 && errno != EINVAL && errno != ENOTSUP) fail(path, "could not be written to the disk");
}

FileClaim::FileClaim(const std::string& path) : lock_(hidden_beside(file_behind(path), ".cradle-lock")) {
  for (;;) {
    Descriptor file(::open(lock_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666));
    if (file < 0) fail(path, "cannot be written", "give another -o FILE or make its folder writable");
    while (::flock(file, LOCK_EX | LOCK_NB) != 0 && errno != ENOLCK && errno != ENOSYS && errno != ENOTSUP) {
      if (errno == EINTR) continue;
      if (errno != EWOULDBLOCK) fail(path, "cannot be locked", "give another -o FILE");
      throw Error({path}, "another program is writing this file", owner(file), "wait for it, or give another -o FILE",
                  Exit::io);
    }
    if (!same_file(file, lock_)) continue;  // the previous owner has just removed it
    write_owner(file);
    held_ = std::move(file);
    remove_leftovers(file_behind(path));
    return;
  }
}

FileClaim::~FileClaim() {
  if (held_ >= 0 && same_file(held_, lock_)) ::unlink(lock_.c_str());
}

NewFile::NewFile(const std::string& path) : path_(path), target_(file_behind(path)) {
  // Finds an unused name: others may belong to other processes or nodes, or be left over from a crash.
  for (int number = 0; file_ < 0; ++number) {
    name_ = hidden_beside(target_, fmt::format(".cradle-{}-{}", ::getpid(), number));
    file_ = Descriptor(::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (file_ < 0 && errno != EEXIST) fail(path, "could not be created");
  }
  struct stat before {};
  if (::stat(target_.c_str(), &before) == 0) static_cast<void>(::fchmod(file_, before.st_mode & 0777) == 0);
}

NewFile::~NewFile() {
  if (!name_.empty()) ::unlink(name_.c_str());
}

void NewFile::append(std::string_view part) {
  if (::lseek(file_, 0, SEEK_END) < 0) fail(path_, "could not be written");
  write({part});
}

void NewFile::take_name(Sync sync) {
  if (::rename(name_.c_str(), target_.c_str()) != 0) fail(path_, "could not be put in place");
  name_.clear();
  if (sync == Sync::yes) sync_folder(target_);
}

void NewFile::put_in_place(Sync sync) {
  if (sync == Sync::yes) sync_file(file_, path_);
  // Some network file systems report only at close that they could not store the data.
  if (::close(file_.release()) != 0) fail(path_, "could not be written");
  take_name(sync);
}

Descriptor NewFile::put_in_place_open(Sync sync) {
  if (sync == Sync::yes) sync_file(file_, path_);
  take_name(sync);
  return std::move(file_);
}

void replace_file(const std::string& path, std::string_view contents, Sync sync) {
  NewFile file(path);
  file.write({contents});
  file.put_in_place(sync);
}

}  // namespace cradle::tools
