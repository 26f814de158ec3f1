#pragma once
// Where the sources are and where they are built: known to one small file, so that no other changes with the folder.

#include <string>

namespace cradle::test {

extern const std::string source_folder, build_folder;

}  // namespace cradle::test
