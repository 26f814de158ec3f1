// Contents of journals without their checksums, which a fuzzer would not guess: the header, records of a run and of an
// ensemble.
#include "cradle/tests/fuzz/fuzz.hpp"
#include "cradle/tools/ensemble/ensemble_store.hpp"
#include "cradle/tools/result/growing_tables.hpp"
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/store/run_journal.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cradle;
  return fuzz::refused_or_read(data, size, [](const std::string& bytes) {
    if (bytes.empty()) return;
    const std::string rest = bytes.substr(1);
    const int kind = bytes[0] % 3;
    if (kind == 0) {
      tools::from_bytes<tools::JournalHeader>(rest);
    } else if (kind == 1) {
      tools::GrowingTables tables(bytes[0] & 4 ? tools::Reading::ends : tools::Reading::everything);
      auto record = tools::from_bytes<tools::RunRecord>(rest);
      if (auto* pieces = std::get_if<std::vector<tools::Group>>(&record))
        for (tools::Group& rows : *pieces) tables.add(std::move(rows));
      tools::in_order(std::move(tables));
    } else {
      static const tools::Scene scene = tools::parse_scene(
          "law.type = 'sticky'\ninitial = { type = 'rows', particles = 8 }\nrun.until = 9\noutput.series.points = 3\n",
          "fuzz.toml");
      tools::EnsembleState state("", scene, {});
      state.apply(tools::from_bytes<tools::EnsembleRecord>(rest));
    }
  });
}
