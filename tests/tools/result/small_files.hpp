#pragma once
// A full disk for this process.

#include <sys/resource.h>

#include <csignal>

namespace cradle::tests {

// During its lifetime files cannot grow beyond 10 kB: further writes fail.
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
