// The Python program tools/plot, carried by this one so that it works wherever it is installed.
#pragma once

#include <span>
#include <string_view>

namespace cradle::tools {

struct EmbeddedFile {
  std::string_view name, text;
};

std::span<const EmbeddedFile> plot_files();

}  // namespace cradle::tools
