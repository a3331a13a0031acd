// SPDX-License-Identifier: MIT
// <director>, and <loop_functions> as one: programs that watch the world and act on it between
// ticks.

#include <utility>

#include "scene/draft.h"
#include "scene/memory.h"

namespace ziggurat::scene {
namespace {

void read_director(Draft& draft, Element& element, Director director) {
  director.where = element.where();
  director.script = element.optional("script", text, "");  // empty: it comes from outside
  director.command = element.optional("command", text, "");
  director.deadline = read_deadline(element, std::nullopt);
  Params params;
  if (auto given = element.child("params")) {
    params = given->all_attributes();
    given->done();
  }
  director.params = with_parameters(std::move(params), draft.parameters);
  take_memory(draft, element, memory_of(director.params), element.size());
  element.done();
  if (!director.script.empty() && !director.command.empty()) {
    element.fault("has a script and a command; write one of them");
  }
  // An entity's id, too: metrics are told by the id of who sets them.
  take_id(element, draft.entity_ids, director.id, "director");
  auto& directors = draft.scene.directors;
  if (directors.size() == Director::most) {
    element.fault(fmt::format("is one too many; a scene has {} directors at most", Director::most));
  }
  directors.push_back(std::move(director));
}

/// Loop functions of a scene for ARGoS are a library, which a server does not load.
void read_loop_functions(Draft& draft, Element& element) {
  const bool is_library = element.has("library") || !element.has("script");
  if (is_library && draft.options.lenient) {
    return draft.report.notice(
        element.where(),
        "<loop_functions> has no effect: libraries are not loaded into the server, and what "
        "this one would do at the start and at each tick is not done");
  }
  element.without_effect("label", text, "a director has an id");
  if (is_library) {
    return element.fault(
        "has no script, and libraries are not loaded into the server; write its rule as a Lua "
        "script "
        "and name it in <director id=\"…\" script=\"…\"/>, or write a director in C++ or Python "
        "and "
        "name it in command=\"…\"; --lenient runs the scene without it");
  }
  Director director;
  director.id = element.optional("id", identifier, "loop_functions");
  draft.report.notice(element.where(), fmt::format("<loop_functions> is read as <director id={}>",
                                                   in_quotes(director.id)));
  read_director(draft, element, std::move(director));
}

}  // namespace

void read_directors(Draft& draft, Element& root) {
  bool has_unnamed = false;
  for (Element& element : root.children("director")) {
    Director director;
    const bool may_be_unnamed = element.has("id") || !std::exchange(has_unnamed, true);
    director.id = may_be_unnamed ? element.optional("id", identifier, "director")
                                 : element.required("id", identifier);
    read_director(draft, element, std::move(director));
  }
  for (Element& element : root.children("loop_functions")) read_loop_functions(draft, element);
}

}  // namespace ziggurat::scene
