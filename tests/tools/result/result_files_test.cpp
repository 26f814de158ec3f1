// Results are read from their files unchanged: in the order in which they were written, with every bit. Files that
// users or older versions have written are read too; damaged ones are not.

#include "cradle/tests/tools/result/result_files.hpp"
#include "cradle/tools/commands/commands.hpp"

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

}  // namespace cradle::tests::result_files_test
