// Writing a file so that at every moment, also after a crash, a full disk or a power cut, its name holds either what
// was there before or all of what is new:
//
//   FileClaim   one writer of a name at a time, for as long as it computes
//   NewFile     the new contents, under a name of their own; synced, closed and only then renamed
//
// The claim is an flock on `.NAME.cradle-lock` beside the file. The file itself cannot carry it, since it is replaced
// or not there yet. A lock file whose mere existence is the lock (O_EXCL) would outlive a crash and block the name;
// flock ends with the process. On NFS Linux makes it a lock of the server's, visible to all nodes. File systems that
// cannot lock (some Lustre mounts) are taken at their word: two writers there still never mix, the last one's file
// stays.
//
// A symbolic link is followed: it stays, and what it names is replaced. Folders, FIFOs, devices and sockets are
// refused.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>

namespace cradle::tools {

/// An open file, closed with its owner.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor();
  operator int() const { return number_; }
  int release() { return std::exchange(number_, -1); }

 private:
  int number_;
};

/// The file that `path` names once links are followed; it need not be there. Throws Error (Exit::io) for what no result
/// may take the place of.
std::string file_behind(const std::string& path);

/// Writes all parts at the descriptor's position. Throws Error (Exit::io) naming `path`.
void write_all(int descriptor, std::array<std::string_view, 3> parts, const std::string& path);

/// To the disk. Throws Error (Exit::io) naming `path`.
void sync_file(int descriptor, const std::string& path);

/// Whoever holds it is the only one to write to the name. Throws Error (Exit::io) where another program does, or where
/// no file can be made: so it also shows before a long run that its result can be written.
class FileClaim {
 public:
  explicit FileClaim(const std::string& path);
  FileClaim(FileClaim&&) = default;
  FileClaim& operator=(FileClaim&&) = delete;
  ~FileClaim();

 private:
  std::string lock_;
  Descriptor held_;
};

enum class Sync { yes, no };  // whether to wait for the disk

/// What is to become the file at `path`; gone with its owner unless put in place. Throws Error (Exit::io).
class NewFile {
 public:
  explicit NewFile(const std::string& path);
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;
  ~NewFile();

  void write(std::array<std::string_view, 3> parts) { write_all(file_, parts, path_); }
  int descriptor() const { return file_; }
  /// Under which it is written.
  const std::string& name() const { return name_; }
  /// Behind what others have written to that name.
  void append(std::string_view part);
  /// To the disk, then under its name.
  void put_in_place(Sync sync = Sync::yes);
  /// The same, still open: to be written on.
  Descriptor put_in_place_open(Sync sync = Sync::yes);

 private:
  void take_name(Sync sync);

  std::string path_;  // as the user named it
  std::string target_, name_;
  Descriptor file_;
};

/// All of it at once.
void replace_file(const std::string& path, std::string_view contents, Sync sync = Sync::yes);

}  // namespace cradle::tools
