// Results are read from their files unchanged: in the order in which they were written, with every bit. Files that
// users or older versions have written are read too; damaged ones are not. Malicious ones, made with HDF5 itself so
// that only the reader can refuse them, give a message that names the file and the place, and status 4; no crash, and
// nothing is written outside the given folder.

#include "cradle/tests/tools/result/result_files.hpp"
#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/result/hdf5.hpp"

namespace cradle::tests::result_files_test {

class ResultFiles : public ProgramTest {
 protected:
  ResultFiles() { write("a.h5", tools::file_image(small_result())); }
};

TEST_F(ResultFiles, ComeBackAsTheyWere) {
  EXPECT_EQ(all_of(read("a.h5")), all_of(small_result()));
  EXPECT_TRUE(tools::file_image(small_result()) == tools::file_image(small_result())) << "other bytes";
}

TEST_F(ResultFiles, ThatHdf5HasChangedAreRead) {
  change(folder / "a.h5", [](hid_t file) { H5Ldelete(file, "snapshots", H5P_DEFAULT); });
  EXPECT_FALSE(has(contents(folder / "a.h5"), "CRADLES1")) << "the seal is gone";
  tools::Result rest = small_result();
  rest.groups.resize(2);
  EXPECT_EQ(all_of(read("a.h5")), all_of(rest));
}

TEST_F(ResultFiles, WhatStandsInPlaceOfASealIsDamage) {
  const std::string whole = contents(folder / "a.h5");
  for (const std::size_t left : {1U, 8U, 23U}) {
    write("a.h5", whole.substr(0, whole.size() - left));
    EXPECT_THROW(read("a.h5"), tools::Error) << left;
  }
  std::string changed = whole;
  changed[whole.size() - tools::seal_size] = '?';
  write("a.h5", changed);
  EXPECT_THROW(read("a.h5"), tools::Error);
  // HDF5 never sees it: what is behind the seal may be damaged, too.
  changed.replace(100, 1000, 1000, '\xff');
  write("a.h5", changed);
  EXPECT_THROW(read("a.h5"), tools::Error);
}

TEST_F(ResultFiles, EndsOfColumnsAreEnoughToListWhatIsThere) {
  tools::Result result = small_result();
  std::vector<double> many(1000);
  for (std::size_t k = 0; k < many.size(); ++k) many[k] = static_cast<double>(k) + 0.5;
  result.groups.push_back({"zone", {}, {{"x", "l", "x", many}, {"pair", "l", "two", many, 2}}});
  write("a.h5", tools::file_image(result));
  const tools::Result ends = tools::read_result(path("a.h5"), tools::Reading::ends);
  const auto& zone = *ends.find("zone");
  EXPECT_EQ(std::get<std::vector<double>>(zone.columns[0].values), (std::vector<double>{0.5, 999.5}));
  EXPECT_EQ(std::get<std::vector<double>>(zone.columns[1].values), (std::vector<double>{0.5, 1.5, 998.5, 999.5}));
  EXPECT_EQ(zone.columns[0].rows(), 1000U);
  EXPECT_EQ(zone.columns[1].rows(), 500U);
  EXPECT_EQ(tools::listing(ends, path("a.h5"), true), tools::listing(read("a.h5"), path("a.h5"), true));
}

TEST_F(ResultFiles, AnyChangedByteIsDetected) {
  const std::string whole = contents(folder / "a.h5"),
                    damaged = path("a.h5") + ": damaged (found its bytes are not those that were written): take it "
                                             "from a copy, or make it anew";
  for (std::size_t at = 0; at < whole.size() - tools::seal_size; at += 97) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    write("a.h5", changed);
    EXPECT_EQ(refusal(tools::Exit::io, [&] { read("a.h5"); }), damaged) << at;
  }
}

TEST_F(ResultFiles, CsvIsCompleteAndCanBeRunAgain) {
  tools::Result result = small_result();
  result.groups[0].attributes = {{"messages", std::string("one\ntwo")}, {"scene", std::string("a = 1\nb = 2\n")}};
  result.groups[0].columns[1].name = "energy, \"kinetic\"";
  result.groups[0].columns.push_back(
      {"how", "1", "", std::vector<std::string>{"mpfr, 50 digits", "\"seen\"", "two\nlines"}});
  tools::export_csv(result, path("csv"));
  EXPECT_EQ(contents(folder / "csv/series.csv"),
            "# messages = one\n#   two\ntime,\"energy, \"\"kinetic\"\"\",collisions,how\n0,2,0,\"mpfr, 50 digits\"\n"
            "0.1,1e-310,7,\"\"\"seen\"\"\"\n3,-0,18446744073709551615,\"two\nlines\"\n");
  EXPECT_EQ(contents(folder / "csv/series/heaviest.csv"), "x[0],x[1]\n1,2\n3,4\n5,6\n");
  EXPECT_TRUE(begins(contents(folder / "csv/scene.toml"), "# format_version = 2\n# cradle_version = 1\n"));
}

// ---- malicious files

using tools::hdf5::Handle;

struct Damage {
  const char* what;
  std::function<void(hid_t file)> how;
  const char* message;  // all of it comes after "cradle: "
};

void put_attribute(hid_t object, const char* name, hid_t type, hsize_t size, const void* data) {
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose, name),
      attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, name);
  H5Awrite(attribute, type, data);
}

void put_dataset(hid_t group, const char* name, hid_t type, std::vector<hsize_t> shape,
                 hid_t properties = H5P_DEFAULT) {
  const Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose, name),
      data(H5Dcreate2(group, name, type, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose, name);
}

Handle open_time(hid_t file) { return {H5Dopen2(file, "series/time", H5P_DEFAULT), H5Dclose, "time"}; }

// Of the letters of C, not of UTF-8 as in results.
Handle text_type(std::size_t size) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "text");
  H5Tset_size(type, size);
  return type;
}

const std::vector<Damage>& damages() {
  static const std::vector<std::uint64_t> many(4096, 0x4141414141414141);
  static const std::vector<Damage> all{
      {"an array as attribute",
       [](hid_t file) { put_attribute(file, "numbers", H5T_NATIVE_UINT64, many.size(), many.data()); },
       "a.h5: @numbers: an attribute is one number or one text (found 4096 of them): "},
      {"an array as attribute of a column",
       [](hid_t file) { put_attribute(open_time(file), "numbers", H5T_NATIVE_UINT64, many.size(), many.data()); },
       "a.h5: series/time@numbers: an attribute is one number or one text (found 4096 of them): "},
      {"an array of texts as attribute",
       [](hid_t file) { put_attribute(file, "texts", text_type(8), 100, many.data()); },
       "a.h5: @texts: an attribute is one number or one text (found 100 of them): "},
      {"a group in itself", [](hid_t file) { H5Lcreate_hard(file, "series", file, "series/again", 0, 0); },
       "a.h5: series/again/again/again"},
      {"the root in itself", [](hid_t file) { H5Lcreate_hard(file, "/", file, "series/root", 0, 0); }, "a.h5: "},
      {"two to the 40 numbers", [](hid_t file) { put_dataset(file, "x", H5T_IEEE_F64LE, {1ULL << 40}); },
       "a.h5: x: more numbers than the file can hold (found 1099511627776 x 1): "},
      {"two to the 40 numbers in chunks",
       [](hid_t file) {
         const Handle chunked(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "chunked");
         const hsize_t chunk = 1024;
         H5Pset_chunk(chunked, 1, &chunk);
         put_dataset(file, "x", H5T_IEEE_F64LE, {1ULL << 40}, chunked);
       },
       "a.h5: x: more numbers than the file can hold (found 1099511627776 x 1): "},
      {"numbers in another file",
       [](hid_t file) {
         const Handle elsewhere(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "elsewhere");
         H5Pset_external(elsewhere, "/etc/passwd", 0, 80);
         put_dataset(file, "x", H5T_IEEE_F64LE, {10}, elsewhere);
       },
       "a.h5: x: a column has its numbers in the file (found a reference to another file): "},
      {"a unit that is a number",
       [](hid_t file) {
         H5Adelete(open_time(file), "unit");
         const double number = 1;
         put_attribute(open_time(file), "unit", H5T_NATIVE_DOUBLE, 1, &number);
       },
       "a.h5: series/time@unit: is to be text (found a number): "},
      {"a column of texts of any length",
       [](hid_t file) { put_dataset(file, "series/texts", text_type(H5T_VARIABLE), {4}); },
       "a.h5: series/texts: a column is made of numbers or of texts as long as each other (found another type): "},
      {"a column of texts that are not there", [](hid_t file) { put_dataset(file, "series/texts", H5T_C_S1, {4}); },
       "a.h5: series/texts: more numbers than the file can hold (found 4 x 1): "},
      {"three dimensions",
       [](hid_t file) { put_dataset(file, "series/cube", H5T_IEEE_F64LE, std::vector<hsize_t>(3, 2)); },
       "a.h5: series/cube: a column has one or two dimensions (found 3): "},
      {"a group above the folder",
       [](hid_t file) {
         H5Gclose(H5Gcreate2(file, "..", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
         put_dataset(file, "../outside", H5T_IEEE_F64LE, {0});
       },
       "a.h5: holds a name that no result has (found ..): "},
      {"a name of two lines",
       [](hid_t file) { H5Gclose(H5Gcreate2(file, "a\nb", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)); },
       "a.h5: holds a name that no result has (found a\nb): "},
      {"no version", [](hid_t file) { H5Adelete(file, "format_version"); },
       "a.h5: not a result of this program (found no attribute format_version): "},
      {"an earlier format",  // which had other names for particles and collisions
       [](hid_t file) {
         H5Adelete(file, "format_version");
         const std::uint64_t first = 1;
         put_attribute(file, "format_version", H5T_NATIVE_UINT64, 1, &first);
       },
       "a.h5: a file of an earlier version of cradle (found format 1, here 2): read it with the version that wrote it, "
       "or remove it and run its scene again\n"}};
  return all;
}

using DamagedFiles = ProgramTest;

TEST_F(DamagedFiles, AreRefusedByName) {
  for (const auto& [what, how, message] : damages()) {
    write("a.h5", tools::file_image(small_result()));
    change(folder / "a.h5", how);
    for (const auto* command :
         {"info a.h5", "export a.h5 --to deep/csv", "plot a.h5", "merge a.h5 -o b.h5", "diff a.h5 a.h5"}) {
      const Printed refused = shell(std::string("timeout 300 cradle ") + command);
      EXPECT_EQ(refused.status, 4) << command << ", " << what << ": " << refused.err;
      EXPECT_TRUE(begins(refused.err, std::string("cradle: ") + message)) << what;
    }
    EXPECT_FALSE(exists("deep") || exists("b.h5")) << what;
  }
}

TEST_F(DamagedFiles, EmptySeriesAreListed) {
  tools::Result result = small_result();
  for (const std::size_t column : {1U, 0U, 2U}) {  // one column of several, two, all
    result.groups[0].columns[column].values = std::vector<double>{};
    write("a.h5", tools::file_image(result));
    shell("cradle info a.h5", 0);
  }
}

}  // namespace cradle::tests::result_files_test
