#pragma once
// The folders of the sources and of the build. Only this file is compiled again when they change.

#include <string>

namespace cradle::test {

extern const std::string source_folder, build_folder;

}  // namespace cradle::test
