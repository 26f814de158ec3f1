#include "cradle/tools/result/result.hpp"

#include <algorithm>

#include "cradle/core/base/state.hpp"
#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

void Column::loaded() const {
  const std::size_t numbers = std::visit([](const auto& v) { return v.size(); }, values);
  require_state(width > 0 && numbers % width == 0, "rows that are not whole");
}

namespace {

template <class Named> const Named* find_in(const std::vector<Named>& all, std::string_view name) {
  const auto at = std::ranges::find(all, name, &Named::name);
  return at == all.end() ? nullptr : &*at;
}

}  // namespace

const Column* Group::find(std::string_view column) const { return find_in(columns, column); }
const Group* Result::find(std::string_view name) const { return find_in(groups, name); }

template <class T>
const T& attribute(const std::vector<Attribute>& attributes, std::string_view name, std::string_view where) {
  if (const T* found = find_attribute<T>(attributes, name)) return *found;
  throw Error({std::string(where), 0, ""}, "not a result of this program", "no attribute " + std::string(name),
              "give a file that cradle wrote", Exit::io);
}
template const std::string& attribute(const std::vector<Attribute>&, std::string_view, std::string_view);
template const double& attribute(const std::vector<Attribute>&, std::string_view, std::string_view);
template const std::uint64_t& attribute(const std::vector<Attribute>&, std::string_view, std::string_view);

}  // namespace cradle::tools
