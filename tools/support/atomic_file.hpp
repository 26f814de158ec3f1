// Writing a file so that its name always holds either the old contents or all of the new ones, also after a crash, a
// full disk or a power cut:
//
//   FileClaim   one writer per name at a time, for as long as it computes
//   NewFile     the new contents, under a temporary name; synced, closed and only then renamed
//
// The claim is an flock on `.NAME.cradle-lock` beside the file. The file itself cannot carry it, since it is replaced
// or does not exist yet. A lock file whose mere existence is the lock (O_EXCL) would outlive a crash and block the
// name; flock ends with the process. On NFS, Linux makes it a lock of the server, visible to all nodes. Some file
// systems (some Lustre mounts) cannot lock: two writers there still never mix their files, the last one's file stays.
//
// A symbolic link is followed: it stays, and the file that it names is replaced. Folders, FIFOs, devices and sockets
// are refused.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>

namespace cradle::tools {

/// An open file, closed by the destructor.
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

/// The file that `path` names after following links; it need not exist. Throws Error (Exit::io) if it is something that
/// a result cannot replace.
std::string file_behind(const std::string& path);

/// What there is at `path` in place of a file: "a folder of that name", "a FIFO", "a device", "a socket"; empty for a
/// file and where there is nothing. To read one might wait for ever or never end.
std::string_view instead_of_file(const std::string& path);

/// Writes all parts at the descriptor's position. Throws Error (Exit::io) naming `path`.
void write_all(int descriptor, std::array<std::string_view, 3> parts, const std::string& path);

/// Syncs to the disk. Throws Error (Exit::io) naming `path`.
void sync_file(int descriptor, const std::string& path);

/// The right to be the only writer of a name. Throws Error (Exit::io) if another program has it, or if no file can be
/// made: so it also shows, before a long run, that its result can be written.
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

/// A new file for `path`; removed by the destructor unless put in place. Throws Error (Exit::io).
class NewFile {
 public:
  explicit NewFile(const std::string& path);
  NewFile& operator=(NewFile&&) = delete;
  ~NewFile();

  void write(std::array<std::string_view, 3> parts) { write_all(file_, parts, path_); }
  int descriptor() const { return file_; }
  /// The temporary name.
  const std::string& name() const { return name_; }
  /// Appends to what others have written to that name.
  void append(std::string_view part);
  /// Syncs the file to the disk, then renames it to `path`.
  void put_in_place(Sync sync = Sync::yes);
  /// The same, but leaves the file open for more writing.
  Descriptor put_in_place_open(Sync sync = Sync::yes);

 private:
  void take_name(Sync sync);

  std::string path_;  // as the user named it
  std::string target_, name_;
  Descriptor file_;
};

/// Writes all contents at once.
void replace_file(const std::string& path, std::string_view contents, Sync sync = Sync::yes);

}  // namespace cradle::tools
