#include "cradle/tools/result/guarded.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <exception>

#include "cradle/tools/support/atomic_file.hpp"
#include "cradle/tools/support/bytes.hpp"
#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

namespace {

// What comes back begins with a status, in eight bytes: that of an Error whose message follows, or done.
[[noreturn]] void answer(int to, const std::function<std::string()>& work) {
  Exit status = Exit::done;
  std::string text;
  try {
    text = work();
  } catch (const Error& error) {
    status = error.status;
    text = error.what();
  } catch (const std::exception& error) {
    status = Exit::io;
    text = error.what();
  }
  try {
    write_all(to, {ByteWriter().put(static_cast<std::uint64_t>(status)).bytes(), text}, "");
  } catch (const Error&) {
    ::_exit(1);
  }
  ::_exit(0);
}

// A crash leaves no core file and no message, and takes its time only.
void confine(unsigned seconds) {
  const rlimit no_core{0, 0}, time{seconds, seconds + 1};
  ::setrlimit(RLIMIT_CORE, &no_core);
  ::setrlimit(RLIMIT_CPU, &time);
  if (const int nowhere = ::open("/dev/null", O_WRONLY); nowhere >= 0) ::dup2(nowhere, STDERR_FILENO);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU}) std::signal(signal, SIG_DFL);
}

std::string read_all(int from) {
  std::string all;
  std::array<char, 1 << 16> part{};
  for (;;) {
    const ssize_t size = ::read(from, part.data(), part.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return all;
    all.append(part.data(), static_cast<std::size_t>(size));
  }
}

}  // namespace

std::optional<std::string> in_another_process(const std::function<std::string()>& work, unsigned seconds) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) throw Error("no pipe: close some files or programs", Exit::io);
  const Descriptor from(ends[0]);
  Descriptor to(ends[1]);
  const pid_t child = ::fork();
  if (child < 0) throw Error("no second process: end some programs", Exit::io);
  if (child == 0) {
    confine(seconds);
    answer(to, work);
  }
  to = Descriptor();
  std::string answered = read_all(from);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || answered.size() < sizeof(std::uint64_t)) return std::nullopt;
  const auto exit = static_cast<Exit>(ByteReader(answered).integer());
  answered.erase(0, sizeof(std::uint64_t));
  if (exit != Exit::done) throw Error(answered, exit);
  return answered;
}

}  // namespace cradle::tools
