// The two folders, as the build defines them.
#include "cradle/tests/places.hpp"

const std::string cradle::test::source_folder = CRADLE_SOURCE_DIR;
const std::string cradle::test::build_folder = CRADLE_BINARY_DIR;
