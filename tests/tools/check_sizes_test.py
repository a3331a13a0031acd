#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""tools/check_sizes.py counts lines and functions as a reader does."""

import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import check_sizes


def functions(source):
    return {name: size for kind, _, name, size in check_sizes.measure(source) if kind == "function"}


def classes(source):
    return {name: size for kind, _, name, size in check_sizes.measure(source) if kind == "class"}


class Functions(unittest.TestCase):
    def test_have_lines_from_name_to_brace(self):
        source = "int one() { return 1; }\n\nint three(int a,\n          int b) {\n  return a; }\n"
        self.assertEqual(functions(source), {"one": 1, "three": 3})

    def test_are_not_the_blocks_in_them(self):
        source = """
std::vector<std::pair<int, int>> pairs(const A<int()>& a) {
  for (const auto& [x, y] : {1, 2}) {
    if (x) { call({x, y}); }
  }
  const auto later = [&](int z) {
    return z;
  };
  switch (x) { default: break; }
}
"""
        self.assertEqual(functions(source), {"pairs": 9})

    def test_may_have_initialisers_and_specifiers(self):
        source = """
Run::Run(const Options& options)
    : options_(options),
      list_{1, 2},
      other_(make({3})) {
  start();
}
Run::~Run() = default;
auto Run::get() const noexcept -> std::optional<int> {
  return 1;
}
bool operator==(const A& a, const A& b) {
  return a.x == b.x;
}
"""
        self.assertEqual(functions(source),
                         {"Run::Run": 6, "Run::get": 3, "operator==": 3})

    def test_are_found_in_namespaces_and_classes(self):
        source = """
namespace a::b {
namespace {
struct S {
  int f() const { return 1; }
};
}  // namespace
void g() {
}
}
"""
        self.assertEqual(functions(source), {"f": 1, "g": 2})

    def test_are_not_in_texts_comments_and_directives(self):
        source = """
// void a() {
/* void b() { */
#define C() {
const char* text = R"(void d() {)";
int e() { return '{' + "{"[0] + 1'000'000; }
"""
        self.assertEqual(functions(source), {"e": 1})

    def test_of_more_than_the_limit_are_violations(self):
        for lines, found in ((59, []), (60, [(1, "f() has 60 lines; 59 are allowed, divide it")])):
            source = "void f() {\n" + "  g();\n" * (lines - 2) + "}\n"
            self.assertEqual(list(check_sizes.violations(source)), found)


class Classes(unittest.TestCase):
    def test_count_data_members_and_friends(self):
        source = """
class A final : public B<int> {
 public:
  A();
  explicit A(int x);
  A(const A&) = delete;
  int f() const { return x_; }
  static std::vector<int> g(std::function<int(int)> call = {});
  bool operator==(const A&) const = default;
  friend void h(A& a);
  friend int of(const A& a) { return a.x_; }

 private:
  class Part {
    int inner();
    int one_ = 1, two_ = 2;
  };
  enum class Kind { a, b };
  static constexpr int most = 3;
  int x_ = count(3), y_{4};
  void (*pointer_)(int) = nullptr;
  std::function<void(int)> callback_;
};
"""
        self.assertEqual(classes(source), {"Part": (2, 0), "A": (4, 2)})

    def test_structs_forward_declarations_and_enumerations_are_none(self):
        self.assertEqual(classes("class A;\nstruct B { int a = 0; };\nenum class C { a, b };\n"), {})

    def test_of_more_than_the_limit_are_violations(self):
        for count, found in ((30, []), (31, [(1, "A has 31 data members; 30 are allowed, divide it")])):
            source = "class A {\n" + "  int a = 0;\n" * count + "};\n"
            self.assertEqual(list(check_sizes.violations(source)), found)
        source = "class A {\n" + "  friend void f();\n" * 4 + "};\n"
        self.assertEqual(list(check_sizes.violations(source)), [(1, "A has 4 friends; 3 are allowed, divide it")])


if __name__ == "__main__":
    unittest.main()
