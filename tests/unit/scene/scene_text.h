// SPDX-License-Identifier: MIT
#pragma once
// A valid scene in parts that a test can replace, and functions to inspect the reported problems.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "scene/reader.h"

namespace ziggurat::scene {

/// The parts of a scene file. Each begins at column 1 of its own line, from line 2 on.
struct SceneText {
  std::string framework = R"(<framework><experiment ticks_per_second="10"/></framework>)";
  std::string controllers = R"(<controllers/>)";
  std::string arena = R"(<arena size="2,2,2"/>)";
  std::string engines = R"(<physics_engines><dynamics3d id="dyn"/></physics_engines>)";
  std::string media = R"(<media/>)";
  std::string rest;

  std::string str() const {
    return "<argos-configuration>\n" + framework + "\n" + controllers + "\n" + arena + "\n" +
           engines + "\n" + media + "\n" + rest + "</argos-configuration>\n";
  }
  ReadResult read(const ReadOptions& options = {}) const {
    return read_text(str(), "test.argos", options);
  }
};

inline std::string all_problems(const ReadResult& result) {
  std::string text;
  for (const Problem& problem : result.problems) {
    text += (problem.severity == Problem::Severity::fault ? "fault  " : "notice ") +
            to_string(problem) + "\n";
  }
  return text;
}

inline std::vector<std::string> texts_of(const ReadResult& result, Problem::Severity severity) {
  std::vector<std::string> texts;
  for (const Problem& problem : result.problems) {
    if (problem.severity == severity) texts.push_back(to_string(problem));
  }
  return texts;
}

inline std::vector<std::string> faults(const ReadResult& result) {
  return texts_of(result, Problem::Severity::fault);
}

inline std::vector<std::string> notices(const ReadResult& result) {
  return texts_of(result, Problem::Severity::notice);
}

/// The text of the only fault; a failure of the test if there is none or another one.
inline std::string only_fault(const ReadResult& result) {
  const auto texts = faults(result);
  EXPECT_EQ(texts.size(), 1u) << all_problems(result);
  return texts.size() == 1 ? texts.front() : "";
}

inline std::size_t count_containing(const std::vector<std::string>& texts,
                                    const std::string& part) {
  return static_cast<std::size_t>(
      std::count_if(texts.begin(), texts.end(),
                    [&](const std::string& text) { return text.find(part) != std::string::npos; }));
}

/// An arena with these elements in it.
inline std::string arena_with(const std::string& elements) {
  return "<arena size=\"4,4,2\" center=\"0,0,1\">" + elements + "</arena>";
}

/// A ball of 1 m and 1 kg.
inline std::string link(const std::string& id) {
  return "<link id=\"" + id + "\" geometry=\"sphere\" radius=\"1\" mass=\"1\"/>";
}

/// A joint at the origins of two links.
inline std::string joint(const std::string& id, const std::string& parent, const std::string& child,
                         const std::string& more = "type=\"fixed\"") {
  return "<joint id=\"" + id + "\" " + more + "><parent link=\"" + parent + "\"/><child link=\"" +
         child + "\"/></joint>\n";
}

/// A prototype whose reference link is `base`.
inline std::string tree(const std::string& links, const std::string& joints,
                        const std::string& rest = "", const std::string& attributes = "id=\"p\"") {
  return "<prototype " + attributes + "><body/><links ref=\"base\">" + links + "</links><joints>" +
         joints + "</joints>" + rest + "</prototype>";
}

}  // namespace ziggurat::scene
