#pragma once
// Compares texts with expected ones; failures print the actual text.

#include <regex>
#include <set>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace cradle::test {

inline testing::AssertionResult has(const std::string& text, const std::string& part) {
  if (text.find(part) == text.npos) return testing::AssertionFailure() << "no '" << part << "' in\n" << text;
  return testing::AssertionSuccess() << "'" << part << "' in\n" << text;
}
inline testing::AssertionResult begins(const std::string& text, const std::string& beginning) {
  if (text.starts_with(beginning)) return testing::AssertionSuccess() << "begins with\n" << text;
  return testing::AssertionFailure() << text << "\n  does not begin with\n" << beginning;
}

// The message of the std::invalid_argument that `work` throws.
template <class Work> std::string message_of(const Work& work) {
  try {
    work();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "nothing was refused";
}

// The first group of every match.
inline std::set<std::string> matches(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::set<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), regex), end; match != end; ++match)
    found.insert((*match)[1]);
  return found;
}

}  // namespace cradle::test
