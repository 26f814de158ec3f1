// Bodies given one by one: from a CSV file whose first line names the columns x,v or x,v,m, or from the scene itself.
// Literals are kept as text, end to end in one string per column, since 2e7 bodies are as welcome as three.
#pragma once

#include <cstddef>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

/// Canonical decimal literals (decimal.hpp), stored in one text.
class DecimalColumn {
 public:
  void push_back(std::string_view literal) {
    text_ += literal;
    ends_.push_back(text_.size());
  }
  std::size_t size() const { return ends_.size(); }
  bool empty() const { return ends_.empty(); }
  std::string_view operator[](std::size_t i) const {
    const std::size_t begin = i == 0 ? 0 : ends_[i - 1];
    return std::string_view(text_).substr(begin, ends_[i] - begin);
  }
  std::string_view back() const { return (*this)[size() - 1]; }

 private:
  std::string text_;
  std::vector<std::size_t> ends_;
};

/// Positions strictly increasing; masses positive, and empty where all are 1.
struct Bodies {
  DecimalColumn x, v, m;
};

/// Reads CSV; blank lines, lines beginning with '#', blanks around commas and CRLF line ends are accepted.
/// Throws Error with file and line.
Bodies parse_list(std::istream& csv, const std::string& file_name);

/// The bodies of a scene of type `list`, from its file or its own arrays. Throws Error; Exit::io where the file cannot
/// be read.
Bodies read_bodies(const Scene& scene);

}  // namespace cradle::tools
