#pragma once
// A full disk, for this process.

#include <sys/resource.h>

#include <csignal>

namespace cradle::tests {

// As long as it lives, files can grow no further than 10 kB: what is written beyond fails.
class SmallFiles {
 public:
  SmallFiles() {
    std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit small = before_;
    small.rlim_cur = 10000;
    ::setrlimit(RLIMIT_FSIZE, &small);
  }
  ~SmallFiles() { ::setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

}  // namespace cradle::tests
