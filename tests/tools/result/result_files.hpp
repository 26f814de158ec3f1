#pragma once
// Small result files to read, and files changed by HDF5.

#include <hdf5.h>

#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/result/files.hpp"
#include "cradle/tools/support/version.hpp"

namespace cradle::tests {

inline tools::Result small_result() {
  tools::Result result;
  result.attributes = {
      {"format_version", tools::format_version},
      {"cradle_version", std::string("1")},
      {"scene", std::string("[law]\ntype = \"sticky\"\n[initial]\ntype = \"rows\"\nparticles = 4\n[run]\nuntil = 3\n")},
      {"outcome", std::string("reached the end")}};
  result.groups.push_back({"series",
                           {},
                           {{"time", "t", "time", std::vector<double>{0, 0.1, 3}},
                            {"energy", "m l^2/t^2", "energy", std::vector<double>{2, 1e-310, -0.0}},
                            {"collisions", "1", "collisions", std::vector<std::uint64_t>{0, 7, ~std::uint64_t{0}}}}});
  result.groups.push_back({"series/heaviest", {}, {{"x", "l", "x", std::vector<double>{1, 2, 3, 4, 5, 6}, 2}}});
  result.groups.push_back({"snapshots/0000", {{"time", 3.0}}, {{"v", "l/t", "v", std::vector<double>{1, -1}}}});
  result.groups.push_back({"snapshots/0001", {{"time", 3.5}}, {{"v", "l/t", "v", std::vector<double>{}}}});
  return result;
}

// All tables as text: CSV has every digit.
inline std::string all_of(const tools::Result& result) {
  std::string text;
  for (const tools::Group& group : result.groups) text += "/" + group.name + "\n" + tools::csv(group);
  return text;
}

// Changes a file through HDF5, as h5py or a user's own program would.
inline void change(const std::filesystem::path& path, const std::function<void(hid_t file)>& how) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  how(file);
  ASSERT_GE(H5Fclose(file), 0);
}

}  // namespace cradle::tests
