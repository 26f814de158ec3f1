#include "cradle/tools/result/result.hpp"

#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

const Group* Result::find(std::string_view name) const {
  for (const auto& group : groups)
    if (group.name == name) return &group;
  return nullptr;
}

template <class T>
const T& attribute(const std::vector<Attribute>& attributes, const std::string& name, const std::string& where) {
  for (const auto& [key, value] : attributes)
    if (key == name)
      if (const T* found = std::get_if<T>(&value)) return *found;
  throw Error({where, 0, ""}, "not a result of this program", "no attribute " + name, "give a file that cradle wrote",
              Exit::io);
}
template const std::string& attribute(const std::vector<Attribute>&, const std::string&, const std::string&);
template const double& attribute(const std::vector<Attribute>&, const std::string&, const std::string&);
template const std::uint64_t& attribute(const std::vector<Attribute>&, const std::string&, const std::string&);

}  // namespace cradle::tools
