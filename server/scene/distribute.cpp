// SPDX-License-Identifier: MIT
// <distribute>: how many copies of one entity, and how their poses are drawn.

#include <algorithm>
#include <array>
#include <limits>

#include "scene/draft.h"
#include "scene/memory.h"

namespace ziggurat::scene {
namespace {

constexpr unsigned most_copies = 1'000'000;  // of all <distribute> together

using Triple = In<math::Vector3>;

void read_uniform(Element& element, Triple triple, Generator& out) {
  const math::Vector3 unknown =
      math::Vector3::Constant(std::numeric_limits<double>::quiet_NaN());  // above nothing
  out.first = element.required("min", triple, unknown);
  out.second = element.required("max", triple, unknown);
  if ((out.first.array() > out.second.array()).any()) {
    element.fault_at("min", "is above max in a component; write min <= max in each");
  }
}

/// @param triple  reads a position, or the degrees of an orientation
Generator read_generator(Element element, Triple triple) {
  Generator out;
  const auto method = needed(element, "method",
                             OneOf<DistributionMethod>{{"uniform", DistributionMethod::uniform},
                                                       {"gaussian", DistributionMethod::gaussian},
                                                       {"constant", DistributionMethod::constant},
                                                       {"grid", DistributionMethod::grid}});
  if (!method) return out;
  out.method = *method;
  switch (out.method) {
    case DistributionMethod::uniform:
      read_uniform(element, triple, out);
      break;
    case DistributionMethod::gaussian:
      out.first = element.required("mean", triple);
      out.second = element.required("std_dev", In{triple.unit, non_negative_vector3});
      break;
    case DistributionMethod::constant:
      out.first = element.required("values", triple);
      break;
    case DistributionMethod::grid:
      out.first = element.required("center", triple);
      out.second = element.required("distances", triple);
      out.layout = element.required("layout", cells, {1, 1, 1});
      break;
  }
  element.done();
  return out;
}

/// Whether a grid has a cell for each of `quantity` entities.
bool has_enough_cells(const Generator& generator, unsigned quantity) {
  if (generator.method != DistributionMethod::grid) return true;
  std::uint64_t total = 1;
  for (const unsigned n : generator.layout) {
    if (total >= quantity) return true;
    total *= n;  // at most 2^32 * 2^32
  }
  return total >= quantity;
}

void read_quantities(Element& entity, Distribution& out) {
  out.quantity = entity.required("quantity", count);
  out.max_trials = entity.required("max_trials", count);
  out.base_num = entity.optional("base_num", count, 0);
  if (out.base_num > std::numeric_limits<unsigned>::max() - out.quantity) {
    entity.fault_at("base_num", "makes numbers above 4294967295; write less");
    out.quantity = 0;
  }
  if (out.quantity > most_copies) {
    entity.fault_at("quantity", fmt::format("is too many; write at most {}", most_copies));
    out.quantity = 0;
  }
  for (const auto& [generator, name] :
       {std::pair(&out.position, "position"), std::pair(&out.orientation, "orientation")}) {
    if (has_enough_cells(*generator, out.quantity)) continue;
    const auto& [x, y, z] = generator->layout;
    entity.fault_at("quantity", fmt::format("is more than the {}x{}x{} cells of its {} grid; "
                                            "enlarge layout or write less",
                                            x, y, z, name));
  }
}

/// Takes the ids of all copies; a taken one is a fault, once.
void take_ids(Draft& draft, Element& pattern, const std::string& id, const Distribution& out) {
  if (!pattern.has("id")) return;
  for (unsigned i = 0; i < out.quantity; ++i) {
    const std::string copy = id + std::to_string(out.base_num + i);
    if (draft.entity_ids.add(copy, pattern.where())) continue;
    pattern.fault_at(
        "id", fmt::format("makes a copy called {}, which is the id of another entity{}; "
                          "choose another id or base_num",
                          in_quotes(copy),
                          draft.report.place(draft.entity_ids.owner(copy), pattern.where())));
    return;
  }
}

/// @param entity  the parent of the pattern
void read_pattern(Draft& draft, const Element& entity, Element& pattern, Distribution& out) {
  if (entity_kind(pattern.name())) {
    out.entity = read_entity(draft, pattern, Placement::distributed);
    const std::size_t each = memory_of(out.entity, controller_of(draft, out.entity));
    take_copies(draft, entity, each, std::max(out.quantity, 1u) - 1);
    take_ids(draft, pattern, out.entity.id, out);
    draft.scene.distributions.push_back(std::move(out));
  } else {
    pattern.unknown_in("entity", entity_names());
  }
}

}  // namespace

void read_distribution(Draft& draft, Element& element) {
  Distribution out;
  out.where = element.where();
  if (auto child = element.required_child("position")) {
    out.position = read_generator(*child, In{"m", position});
  }
  if (auto child = element.required_child("orientation")) {
    out.orientation = read_generator(*child, In{"°", vector3});
  }
  auto entity = element.required_child("entity");
  element.done();
  if (!entity) return;
  read_quantities(*entity, out);
  std::vector<Element> patterns = entity->children();
  entity->done();
  if (patterns.empty()) {
    entity->fault("has nothing to distribute; write one entity, such as <box …>, in it");
    return;
  }
  if (patterns.size() > 1) {
    draft.report.notice(patterns[1].where(),
                        "only the first entity of a <distribute> has an effect");
  }
  if (draft.copies + out.quantity > most_copies) {
    entity->fault_at("quantity", fmt::format("makes more than {} distributed entities; write less",
                                             most_copies));
    return;
  }
  draft.copies += out.quantity;
  read_pattern(draft, *entity, patterns.front(), out);
}

}  // namespace ziggurat::scene
