// tools/plot.py, carried by the program so that it works wherever it is installed.
#pragma once

#include <string_view>

namespace cradle::tools {

std::string_view plot_script();

}  // namespace cradle::tools
