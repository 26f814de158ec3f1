// Malicious files: each gives a message that names the file and the place, and status 4; no crash, and nothing is
// written outside the given folder. All are made with HDF5 itself, so that only the reader can refuse them.

#include "cradle/tests/tools/result/result_files.hpp"

namespace cradle::tests::damaged_files_test {

struct Damage {
  const char* what;
  std::function<void(hid_t file)> how;
  const char* message;  // all of it comes after "cradle: "
};

void put_attribute(hid_t object, const char* name, hid_t type, hsize_t size, const void* data) {
  const hid_t space = H5Screate_simple(1, &size, nullptr);
  const hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(attribute, type, data);
  H5Aclose(attribute);
  H5Sclose(space);
}

hid_t put_dataset(hid_t group, const char* name, hid_t type, std::vector<hsize_t> shape,
                  hid_t properties = H5P_DEFAULT) {
  const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
  const hid_t data = H5Dcreate2(group, name, type, space, H5P_DEFAULT, properties, H5P_DEFAULT);
  H5Sclose(space);
  return data;
}

const std::vector<Damage>& damages() {
  static const std::vector<std::uint64_t> many(4096, 0x4141414141414141);
  static const std::vector<Damage> all{
      {"an array as attribute",
       [](hid_t file) { put_attribute(file, "numbers", H5T_NATIVE_UINT64, many.size(), many.data()); },
       "a.h5: @numbers: an attribute is one number or one text (found 4096 of them): "},
      {"an array as attribute of a column",
       [](hid_t file) {
         const hid_t data = H5Dopen2(file, "series/time", H5P_DEFAULT);
         put_attribute(data, "numbers", H5T_NATIVE_UINT64, many.size(), many.data());
         H5Dclose(data);
       },
       "a.h5: series/time@numbers: an attribute is one number or one text (found 4096 of them): "},
      {"an array of texts as attribute",
       [](hid_t file) {
         const hid_t type = H5Tcopy(H5T_C_S1);
         H5Tset_size(type, 8);
         put_attribute(file, "texts", type, 100, many.data());
         H5Tclose(type);
       },
       "a.h5: @texts: an attribute is one number or one text (found 100 of them): "},
      {"a group in itself", [](hid_t file) { H5Lcreate_hard(file, "series", file, "series/again", 0, 0); },
       "a.h5: series/again/again/again"},
      {"the root in itself", [](hid_t file) { H5Lcreate_hard(file, "/", file, "series/root", 0, 0); }, "a.h5: "},
      {"two to the 40 numbers", [](hid_t file) { H5Dclose(put_dataset(file, "x", H5T_IEEE_F64LE, {1ULL << 40})); },
       "a.h5: x: more numbers than the file can hold (found 1099511627776 x 1): "},
      {"two to the 40 numbers in chunks",
       [](hid_t file) {
         const hid_t chunked = H5Pcreate(H5P_DATASET_CREATE);
         const hsize_t chunk = 1024;
         H5Pset_chunk(chunked, 1, &chunk);
         H5Dclose(put_dataset(file, "x", H5T_IEEE_F64LE, {1ULL << 40}, chunked));
         H5Pclose(chunked);
       },
       "a.h5: x: more numbers than the file can hold (found 1099511627776 x 1): "},
      {"numbers in another file",
       [](hid_t file) {
         const hid_t elsewhere = H5Pcreate(H5P_DATASET_CREATE);
         H5Pset_external(elsewhere, "/etc/passwd", 0, 80);
         H5Dclose(put_dataset(file, "x", H5T_IEEE_F64LE, {10}, elsewhere));
         H5Pclose(elsewhere);
       },
       "a.h5: x: a column has its numbers in the file (found a reference to another file): "},
      {"a unit that is a number",
       [](hid_t file) {
         const hid_t data = H5Dopen2(file, "series/time", H5P_DEFAULT);
         H5Adelete(data, "unit");
         const double number = 1;
         put_attribute(data, "unit", H5T_NATIVE_DOUBLE, 1, &number);
         H5Dclose(data);
       },
       "a.h5: series/time@unit: is to be text (found a number): "},
      {"a column of texts of any length",
       [](hid_t file) {
         const hid_t type = H5Tcopy(H5T_C_S1);
         H5Tset_size(type, H5T_VARIABLE);
         H5Dclose(put_dataset(file, "series/texts", type, {4}));
         H5Tclose(type);
       },
       "a.h5: series/texts: a column is made of numbers or of texts as long as each other (found another type): "},
      {"a column of texts that are not there",
       [](hid_t file) { H5Dclose(put_dataset(file, "series/texts", H5T_C_S1, {4})); },
       "a.h5: series/texts: more numbers than the file can hold (found 4 x 1): "},
      {"three dimensions",
       [](hid_t file) {
         H5Dclose(put_dataset(file, "series/cube", H5T_IEEE_F64LE, {2, 2, 2}));
       },
       "a.h5: series/cube: a column has one or two dimensions (found 3): "},
      {"a group above the folder",
       [](hid_t file) {
         H5Gclose(H5Gcreate2(file, "..", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
         H5Dclose(put_dataset(file, "../outside", H5T_IEEE_F64LE, {0}));
       },
       "a.h5: holds a name that no result has (found ..): "},
      {"a name of two lines",
       [](hid_t file) { H5Gclose(H5Gcreate2(file, "a\nb", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)); },
       "a.h5: holds a name that no result has (found a\nb): "},
      {"no version", [](hid_t file) { H5Adelete(file, "format_version"); },
       "a.h5: not a result of this program (found no attribute format_version): "}};
  return all;
}

class DamagedFiles : public ProgramTest {};

TEST_F(DamagedFiles, AreRefusedByName) {
  for (const auto& [what, how, message] : damages()) {
    write("a.h5", tools::file_image(small_result()));
    change(folder / "a.h5", how);
    for (const auto* command : {"info a.h5", "export a.h5 --to deep/csv", "plot a.h5", "merge a.h5 -o b.h5"}) {
      const Printed refused = shell(std::string("timeout 300 cradle ") + command);
      EXPECT_EQ(refused.status, 4) << command << ", " << what << ": " << refused.err;
      EXPECT_TRUE(begins(refused.err, std::string("cradle: ") + message)) << what;
    }
    EXPECT_FALSE(exists("deep") || exists("b.h5")) << what;
  }
}

// Results, journals of runs and of ensembles, checkpoints. Format 1 had other names for particles and collisions.
TEST_F(DamagedFiles, OfAnEarlierFormatAreRefusedInOneWay) {
  tools::Result result = small_result();
  result.attributes[0].second = std::uint64_t{1};
  write("a.h5", tools::file_image(result));
  write("run.h5.part", std::string("CRADLER1") + std::string(40, 'x'));
  write("ensemble.h5.part", std::string("CRADLEJ2") + std::string(40, 'x'));
  write("run.h5.checkpoint", std::string("CRADLEC1") + std::string(40, 'x'));
  const struct {
    std::string file, formats;
    std::vector<std::string> commands;
  } refusals[] = {
      {"a.h5", "1, here 2", {"info a.h5", "export a.h5 --to csv", "plot a.h5", "merge a.h5 -o b.h5", "diff a.h5 a.h5"}},
      {"run.h5.part", "1, here 4", {"info run.h5.part", "resume run.h5"}},
      {"ensemble.h5.part",
       "2, here 4",
       {"info ensemble.h5.part", "resume ensemble.h5", "ensemble fig2 --replicas 2 -o ensemble.h5"}},
      {"run.h5.checkpoint", "1, here 4", {"info run.h5.checkpoint"}}};
  for (const auto& [file, formats, commands] : refusals)
    for (const std::string& command : commands)
      EXPECT_EQ(shell("cradle " + command, 4).err,
                "cradle: " + file + ": a file of an earlier version of cradle (found format " + formats +
                    "): read it with the version that wrote it, or remove it and run its scene again\n")
          << command;
}

TEST_F(DamagedFiles, EmptySeriesAreListed) {
  tools::Result result = small_result();
  for (auto& column : result.groups[0].columns) column.values = std::vector<double>{};
  write("a.h5", tools::file_image(result));
  shell("cradle info a.h5", 0);
  // One column of several.
  result = small_result();
  result.groups[0].columns[1].values = std::vector<double>{};
  write("a.h5", tools::file_image(result));
  shell("cradle info a.h5", 0);
}

}  // namespace cradle::tests::damaged_files_test
