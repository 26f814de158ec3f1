#include "cradle/tools/result/result_bytes.hpp"

#include "cradle/tools/support/bytes.hpp"

namespace cradle::tools {

namespace {

// Of values, as bytes name them; those of columns in the order of Numbers.
constexpr std::uint64_t text_kind = 0, real_kind = 1, whole_kind = 2;
constexpr std::uint64_t kinds_of_columns[] = {real_kind, whole_kind, text_kind};

void put(ByteWriter& bytes, const std::vector<Attribute>& attributes) {
  bytes.put(std::uint64_t{attributes.size()});
  for (const auto& [name, value] : attributes) {
    bytes.put(name).put(std::uint64_t{value.index()});
    std::visit([&](const auto& v) { bytes.put(v); }, value);
  }
}

std::vector<Attribute> attributes_in(ByteReader& bytes) {
  std::vector<Attribute> attributes;
  for (std::uint64_t left = bytes.integer(); left > 0; --left) {
    std::string name = bytes.text();
    switch (bytes.integer()) {
    case text_kind:
      attributes.emplace_back(std::move(name), bytes.text());
      break;
    case real_kind:
      attributes.emplace_back(std::move(name), bytes.number<double>());
      break;
    default:
      attributes.emplace_back(std::move(name), bytes.integer());
    }
  }
  return attributes;
}

void put(ByteWriter& bytes, const Column& column) {
  bytes.put(column.name).put(column.unit).put(column.description);
  bytes.put(std::uint64_t{column.width}).put(column.left_out).put(kinds_of_columns[column.values.index()]);
  std::visit([&](const auto& values) { bytes.put(values); }, column.values);
}

Column column_in(ByteReader& bytes) {
  Column column{bytes.text(), bytes.text(), bytes.text(), {}};
  column.width = bytes.integer();
  column.left_out = bytes.integer();
  switch (bytes.integer()) {
  case text_kind:
    column.values = bytes.texts();
    break;
  case real_kind:
    column.values = bytes.numbers<double>();
    break;
  default:
    column.values = bytes.numbers<std::uint64_t>();
  }
  const std::size_t numbers = std::visit([](const auto& values) { return values.size(); }, column.values);
  if (column.width == 0 || numbers % column.width != 0)
    throw Error({{}, 0, column.name}, "rows that are not whole", "", "use the program that wrote them", Exit::io);
  return column;
}

}  // namespace

std::string to_bytes(const Result& result) {
  ByteWriter bytes;
  put(bytes, result.attributes);
  bytes.put(std::uint64_t{result.groups.size()});
  for (const Group& group : result.groups) {
    bytes.put(group.name);
    put(bytes, group.attributes);
    bytes.put(std::uint64_t{group.columns.size()});
    for (const Column& column : group.columns) put(bytes, column);
  }
  return std::move(bytes).bytes();
}

Result result_of_bytes(std::string_view all) {
  ByteReader bytes(all);
  Result result{attributes_in(bytes), {}};
  for (std::uint64_t groups = bytes.integer(); groups > 0; --groups) {
    Group group{bytes.text(), {}, {}};
    group.attributes = attributes_in(bytes);
    for (std::uint64_t columns = bytes.integer(); columns > 0; --columns) group.columns.push_back(column_in(bytes));
    result.groups.push_back(std::move(group));
  }
  return result;
}

}  // namespace cradle::tools
