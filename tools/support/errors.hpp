// Errors that users can cause or meet: bad input, files, collapse. One exception carries the message and the exit
// status. Messages have the form  `what is wrong (what was found): what to do`  and begin with a place: `fig2.toml:7:
// law.restitution: ` in a scene file, `--set law.restitution: ` on the command line.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace cradle::tools {

/// Exit statuses of the program.
enum class Exit : int {
  done = 0,
  differs = 1,        // a comparison differs
  bad_input = 2,      // the scene or the command line
  collapse = 3,       // stopped at inelastic collapse (policy `stop`)
  io = 4,             // a file could not be read or written
  lost = 5,           // resolution or order lost, a replica failed, or a proof is undecided
  processor = 6,      // lacks instructions that the program is compiled for
  interrupted = 130,  // SIGINT
  terminated = 143,   // SIGTERM, SIGUSR1, SIGHUP
};

/// The text with its control characters written out, so that none cuts a message or reaches a terminal.
inline std::string printable(std::string_view text) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string shown;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if ((code >= 0x20 && code != 0x7F) || c == '\n')
      shown += c;
    else
      shown.append("\\x").append(1, digits[code / 16U]).append(1, digits[code % 16U]);
  }
  return shown;
}

/// The beginning of a text of a user, for a message.
inline std::string excerpt(std::string_view text) {
  std::size_t most = 100;
  if (text.size() <= most) return std::string(text);
  while (most > 0 && (static_cast<unsigned char>(text[most]) & 0xC0U) == 0x80U)
    --most;  // of a character of several bytes
  return std::string(text.substr(0, most)) + "...";
}

/// A place in the input; each part may be missing (empty, or line 0).
struct Place {
  std::string source = {};  // file as the user named it, or "--set"
  std::size_t line = 0;     // from 1; 0: unknown
  std::string key = {};     // "law.restitution"

  /// "fig2.toml:7: law.restitution: ", "--set law.restitution: ", "" where nothing is known.
  std::string prefix() const {
    std::string text = source;
    if (line > 0) text += ":" + std::to_string(line);
    if (key.empty()) return text.empty() ? text : text + ": ";
    if (!text.empty()) text += source == "--set" ? " " : ": ";
    return text + excerpt(key) + ": ";
  }
};

class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message, Exit status_ = Exit::bad_input)
      : std::runtime_error(printable(message)), status(status_) {}

  /// `wrong (found FOUND): advice` after the place's prefix; without "(found ...)" where `found` is empty.
  Error(const Place& place, std::string_view wrong, std::string_view found, std::string_view advice,
        Exit status_ = Exit::bad_input)
      : Error(compose(place, wrong, found, advice), status_) {}

  Exit status;

 private:
  static std::string compose(const Place& place, std::string_view wrong, std::string_view found,
                             std::string_view advice) {
    std::string text = place.prefix();
    text += wrong;
    if (!found.empty()) text.append(" (found ").append(found).append(")");
    return text.append(": ").append(advice);
  }
};

}  // namespace cradle::tools
