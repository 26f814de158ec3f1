// Every row of the table of keys is given a value of every type that TOML has. Whatever is not of the type of the key
// is refused with file, line and key, and nothing but a scene or such a refusal comes of any value.

#include "cradle/tests/tools/cases.hpp"
#include "cradle/tools/scene/fields.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tools::wrong_types_test {

using Assignments = std::map<std::string, std::string>;

std::string text_of(const Assignments& scene) {
  std::string text;
  for (const auto& [key, value] : scene) text.append(key).append(" = ").append(value).append("\n");
  return text;
}

Scene parse(const Assignments& scene) { return parse_scene(text_of(scene), "s.toml"); }

Assignments with(const Assignments& scene, Assignments more) {
  more.insert(scene.begin(), scene.end());
  return more;
}

// Scenes that together have every row of the table.
std::vector<Assignments> scenes() {
  std::vector<Assignments> all;
  for (const tests::ListedCase& listed : tests::cases_in("scene/every_key.txt")) {
    Assignments& one = all.emplace_back();
    for (const std::string& line : listed.lines) {
      const auto equals = line.find(" = ");
      one.emplace(line.substr(0, equals), line.substr(equals + 3));
    }
  }
  return all;
}

// `key` with this value, in place of what the scene says of it.
Assignments with_value(Assignments scene, const std::string& key, const std::string& value) {
  std::erase_if(scene, [&](const auto& entry) { return entry.first == key || entry.first.starts_with(key + "."); });
  return with(scene, {{key, value}});
}

void expect_place(const std::string& message, const Assignments& scene, const std::string& key) {
  const auto line = 1 + std::distance(scene.begin(), scene.find(key));
  // A message on one of the keys of a table names this one.
  const std::regex place("^s\\.toml:" + std::to_string(line) + ": " + key + "[.a-z_]*: [^:]+: .+");
  EXPECT_TRUE(std::regex_search(message, place)) << message;
}

// Empty where the scene was taken.
std::string answer(const Assignments& scene, const std::vector<std::string>& settings = {}) {
  try {
    parse_scene(text_of(scene), "s.toml", settings);
    return "";
  } catch (const Error& error) {
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "not an Error: " << error.what() << "\n" << text_of(scene) << testing::PrintToString(settings);
    return "";
  }
}

struct Wrong {
  const char *type, *value;  // the types that take it, or may
};
std::vector<Wrong> wrong_values() {
  const std::pair<const char*, std::vector<const char*>> of_types[] = {
      {"text", {"'a'", "''"}},
      {"number", {"5", "-2.5e3", "0x1F"}},
      {"text number", {"'5'"}},
      {"boolean", {"true", "false"}},
      {"numbers", {"[1, 2]"}},
      {"texts", {"['a']"}},
      {"numbers texts", {"[]", "['1', '2']"}},
      {"", {"[true]", "[1, 'a']", "[[]]", "[[1]]", "[['a'], 1]", "[{}]", "[{ a = 1 }]", "[1, {}]", "{}", "{ a = 1 }"}},
      {"", {"{ a.b.c = 1 }", "{ until = {} }", "{ every = [] }", "{ points = 'a' }", "{ points = { a = 1 } }"}},
      {"", {"{ every = 1979-05-27 }", "{ every = 1, from = true }", "{ every = 1, until = {} }"}},
      {"", {"{ points = 3, spacing = [1] }", "{ points = 3, spacing = 3 }", "nan", "[inf]"}},
      {"", {"1979-05-27", "07:32:00", "1979-05-27T07:32:00Z", "[1979-05-27]"}}};
  std::vector<Wrong> all;
  for (const auto& [type, values] : of_types)
    for (const char* value : values) all.push_back({type, value});
  return all;
}
const std::vector<Wrong> values = wrong_values();

std::string kind(const Field& field) {
  const auto type = type_name(field);
  if (type == "text" || type == "one of") return "text";
  if (type == "true or false") return "boolean";
  if (type.starts_with("list of numbers")) return "numbers";
  if (type.starts_with("list of texts")) return "texts";
  return "number";
}

// Calls of(field, scene) for every row of the table and a scene to which it applies.
template <class F> void for_each_row(const F& of) {
  const std::vector<Assignments> all = scenes();
  for (const Field& field : scene_fields()) {
    bool applied = false;
    for (const Assignments& scene : all) {
      Assignments plain = scene;
      if (plain.erase("initial.file") > 0) plain = with(plain, {{"initial.x", "[0]"}, {"initial.v", "[0]"}});
      if (!field.when->holds(parse(plain))) continue;
      applied = true;
      of(field, scene);
      break;
    }
    EXPECT_TRUE(applied) << field.key;
  }
}

bool may_be(const Wrong& wrong, const Field& field) {
  return tests::has(std::string(" ") + wrong.type + " ", " " + kind(field) + " ");
}

TEST(WrongTypes, OfEveryKeyAreRefusedWithFileLineAndKey) {
  for_each_row([](const Field& field, const Assignments& scene) {
    for (const Wrong& wrong : values) {
      const Assignments given = with_value(scene, std::string(field.key), wrong.value);
      const std::string message = answer(given);
      if (!may_be(wrong, field)) expect_place(message, given, std::string(field.key));
    }
  });
}

// What is no table where there are only tables.
TEST(WrongTypes, OfEveryTableAreRefusedWithFileLineAndKey) {
  const Assignments scene = scenes().front();
  for (const Field& field : scene_fields())
    for (auto dot = field.key.find('.'); dot != field.key.npos; dot = field.key.find('.', dot + 1))
      for (const Wrong& wrong : values) {
        const std::string table(field.key.substr(0, dot)), value = wrong.value;
        if (value.starts_with('{')) continue;
        const Assignments given = with_value(scene, table, value);
        expect_place(answer(given), given, table);
      }
}

// The command line has no lines, and a bare word there is a text.
TEST(WrongTypes, OnTheCommandLineAreRefusedWithTheirKey) {
  for_each_row([](const Field& field, const Assignments& scene) {
    for (const Wrong& wrong : values) {
      const std::string setting = std::string(field.key) + "=" + wrong.value;
      const std::string message = answer(scene, {setting});
      if (may_be(wrong, field) || type_name(field) == "text") continue;
      EXPECT_TRUE(tests::begins(message, "--set " + std::string(field.key))) << setting;
    }
  });
}

}  // namespace cradle::tools::wrong_types_test
