// HDF5 identifiers as values that close themselves, and failures as errors that name the file. Only functions with the
// same names and arguments in HDF5 1.10 to 1.14 are used.
#pragma once

#include <hdf5.h>

#include <string>
#include <utility>

#include "cradle/tools/support/errors.hpp"

namespace cradle::tools::hdf5 {

inline Error failure(const std::string& what) {
  return {{}, what, "", "give a result file that cradle wrote, or make it anew", Exit::io};
}

inline void check(herr_t status, const std::string& what) {
  if (status < 0) throw failure(what);
}

class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close closer, const std::string& what) : id_(id), close_(closer) {
    if (id_ < 0) throw failure(what);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  Close close_;
};

/// UTF-8 text of at most so many bytes, or of any length.
inline Handle text_type(const std::string& path, std::size_t bytes = H5T_VARIABLE) {
  const std::string none = path + ": no text type";
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, none);
  check(H5Tset_size(type, bytes), none);
  if (bytes != H5T_VARIABLE) check(H5Tset_strpad(type, H5T_STR_NULLPAD), none);
  check(H5Tset_cset(type, H5T_CSET_UTF8), none);
  return type;
}

/// Call it first. It turns off HDF5's own error messages, since ours name the file and what to do, and HDF5's work at
/// exit: there it would write again what did not fit on a full disk, and crash.
inline void silence() {
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

}  // namespace cradle::tools::hdf5
