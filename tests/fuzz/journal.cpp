// Contents of journals, as they are behind their checksums, which a fuzzer would not guess: header and records of a
// run, header and records of an ensemble.
#include "cradle/tests/fuzz/fuzz.hpp"
#include "cradle/tools/store/ensemble_journal.hpp"
#include "cradle/tools/store/run_journal.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cradle;
  return fuzz::refused_or_read(data, size, [](const std::string& bytes) {
    if (bytes.empty()) return;
    const std::string_view rest = std::string_view(bytes).substr(1);
    switch (bytes[0] % 4) {
    case 0:
      tools::RunHeader::of(rest);
      break;
    case 1: {
      tools::GrowingTables tables(bytes[0] & 4 ? tools::Reading::ends : tools::Reading::everything);
      for (tools::Group& rows : tools::rows_in(rest)) tables.add(std::move(rows));
      std::move(tables).in_order();
      break;
    }
    case 2:
      tools::header_in(rest);
      break;
    default: {
      static const tools::Scene scene = tools::parse_scene(
          "law.type = 'sticky'\ninitial = { type = 'rows', particles = 8 }\nrun.until = 9\noutput.series.points = 3\n",
          "fuzz.toml");
      tools::EnsembleState state("", scene, {});
      state.apply(rest);
    }
    }
  });
}
