// SPDX-License-Identifier: MIT
// <links> and <joints> of a prototype: bodies and how they hang together.

#include <algorithm>
#include <numbers>
#include <queue>

#include "scene/draft.h"

namespace ziggurat::scene {
namespace {

constexpr Surface link_surface{0.5, 0.0};
constexpr Damping link_damping{0.04, 0.04};

/// @param distinct  made false if the link's name can't be told from another's
Link read_link(Draft& draft, Element& element, Ids& ids, bool& distinct) {
  Link link;
  link.where = element.where();
  const bool named = element.has("id");
  link.id = element.optional("id", identifier, "");
  if (!named) link.id = ids.next("link", link.where);
  if (link.id == "origin") {
    distinct = false;
    element.fault_at("id", "is the name of the entity's own frame; choose another");
  } else if (named && !take_id(element, ids, link.id, "link")) {
    distinct = false;
  }
  link.geometry = read_geometry(draft, element);
  link.mass = element.required("mass", mass, 1.0);
  link.offset = read_pose(element);
  link.surface = read_surface(draft, element, link_surface);
  link.damping = read_damping(draft, element, link_damping);
  element.done();
  return link;
}

std::optional<std::size_t> read_link_name(Element& element, const char* attribute,
                                          const Draft& draft) {
  const std::string id = element.required(attribute, identifier);
  if (id.empty()) return std::nullopt;
  const auto found = draft.anchors.find(id);
  if (found != draft.anchors.end()) return found->second;
  std::vector<std::string> links = anchor_names(draft);
  links.erase(links.begin());
  element.fault_at(attribute, "names no link; " + draft.report.advice(id, links),
                   {"links", "link", "id", duplicate});
  return std::nullopt;
}

/// `<parent>` or `<child>` of a joint; false after a fault.
bool read_side(const Draft& draft, Element& joint, const char* name, std::size_t& link,
               math::Pose& frame) {
  auto side = joint.required_child(name);
  if (!side) return false;
  const auto found = read_link_name(*side, "link", draft);
  frame = read_pose(*side);
  side->done();
  if (found) link = *found;
  return found.has_value();
}

void read_axis_and_limit(Element& element, Joint& joint) {
  if (!has_coordinate(joint.type)) {
    constexpr std::string_view why = "only prismatic and revolute joints have one";
    element.without_effect("axis", vector3, why);
    element.without_effect("limit", range, why);
    return;
  }
  joint.axis = element.required("axis", direction, math::Vector3::UnitZ());
  if (const auto limit = element.optional("limit", In{"m or °", range})) {
    if (joint.type == JointType::revolute) doubt_angles(element, "limit");
    const double unit = joint.type == JointType::revolute ? std::numbers::pi / 180.0 : 1.0;
    joint.limit = JointLimit{limit->first * unit, limit->second * unit};
    if (joint.limit->lower > 0 || joint.limit->upper < 0) {
      element.report().warn(
          element.where("limit"), "limits without 0",
          element.sentence(
              "limit",
              "leaves out 0, where the joint is assembled: it is moved into its limits as the run "
              "begins; measure limits from the assembled pose"));
    }
  }
}

/// A joint, or nothing if it connects no two links.
std::optional<Joint> read_joint(const Draft& draft, Element& element, Ids& ids) {
  Joint joint;
  joint.where = element.where();
  const bool named = element.has("id");
  joint.id = element.optional("id", identifier, "");
  if (!named) joint.id = ids.next("joint", joint.where);
  if (named) take_id(element, ids, joint.id, "joint");
  const auto type = needed(element, "type",
                           OneOf<JointType>{{"fixed", JointType::fixed},
                                            {"spherical", JointType::spherical},
                                            {"prismatic", JointType::prismatic},
                                            {"revolute", JointType::revolute}});
  joint.type = type.value_or(JointType::revolute);  // for which nothing more is refused
  if (type) {
    read_axis_and_limit(element, joint);
  } else {
    for (const char* name : {"axis", "limit"}) element.optional(name, text);
    draft.report.left_out(joint_type);
  }
  element.without_effect("disable_collision", boolean,
                         "links of one prototype never collide with each other");
  const bool parent = read_side(draft, element, "parent", joint.parent, joint.parent_frame);
  const bool child = read_side(draft, element, "child", joint.child, joint.child_frame);
  element.done();
  if (!parent || !child) return std::nullopt;
  return joint;
}

constexpr std::size_t none = static_cast<std::size_t>(-1);

/// Advice for a joint whose child has a place in the tree already.
std::string_view advice_on_closing(const Entity& entity, const Joint& joint) {
  const bool is_parent_placed = joint.parent == entity.reference_link ||
                                std::ranges::any_of(entity.joints, [&](const Joint& other) {
                                  return &other != &joint && other.child == joint.parent;
                                });
  if (!is_parent_placed) return "swap its parent and child";
  return "links form a tree, in which no loop of joints can be closed: leave this joint out, and "
         "let a controller "
         "drive the others so that both ends stay together, or hold them together with magnets";
}

/// The joint that leads to each link, or `none`; a second one is a fault.
std::vector<std::size_t> incoming_joints(Report& report, const Entity& entity, bool& sound) {
  std::vector<std::size_t> incoming(entity.links.size(), none);
  for (std::size_t i = 0; i < entity.joints.size(); ++i) {
    const Joint& joint = entity.joints[i];
    const std::string child = in_quotes(entity.links[joint.child].id);
    if (joint.child == entity.reference_link) {
      sound = false;
      report.fault(joint.where,
                   fmt::format("joint {} has the reference link {} as its child; {}",
                               in_quotes(joint.id), child, advice_on_closing(entity, joint)));
    } else if (incoming[joint.child] != none) {
      sound = false;
      report.fault(joint.where,
                   fmt::format("joint {} gives link {} a second parent, after joint {}; {}",
                               in_quotes(joint.id), child,
                               in_quotes(entity.joints[incoming[joint.child]].id),
                               advice_on_closing(entity, joint)));
    } else {
      incoming[joint.child] = i;
    }
  }
  return incoming;
}

/// Reports each cycle and each unconnected part of the tree once.
void report_unreached(Report& report, const Entity& entity,
                      const std::vector<std::size_t>& incoming) {
  enum class Mark : char { unseen, current, known };
  std::vector<Mark> marks(entity.links.size(), Mark::unseen);
  marks[entity.reference_link] = Mark::known;
  for (std::size_t start = 0; start < entity.links.size(); ++start) {
    std::vector<std::size_t> path;
    std::size_t link = start;
    while (marks[link] == Mark::unseen) {
      marks[link] = Mark::current;
      path.push_back(link);
      if (incoming[link] == none) break;
      link = entity.joints[incoming[link]].parent;
    }
    if (!path.empty() && incoming[link] == none && link == path.back()) {
      report.fault(entity.links[link].where,
                   fmt::format("link {} is not connected to the reference link {}; add a joint "
                               "whose child it is",
                               in_quotes(entity.links[link].id),
                               in_quotes(entity.links[entity.reference_link].id)),
                   {"joints", "joint"});
    } else if (marks[link] == Mark::current) {
      const Joint& joint = entity.joints[incoming[link]];
      report.fault(
          joint.where,
          fmt::format("joint {0} is part of a loop that never meets the reference link {1}; links "
                      "form a tree: leave "
                      "this joint out, and let one from {1} lead to its child",
                      in_quotes(joint.id), in_quotes(entity.links[entity.reference_link].id)));
    }
    for (const std::size_t passed : path) marks[passed] = Mark::known;
  }
}

}  // namespace

void order_joints(Report& report, Entity& entity) {
  bool sound = true;
  const std::vector<std::size_t> incoming = incoming_joints(report, entity, sound);
  std::vector<std::vector<std::size_t>> outgoing(entity.links.size());
  for (std::size_t i = 0; i < entity.joints.size(); ++i) {
    if (incoming[entity.joints[i].child] == i) outgoing[entity.joints[i].parent].push_back(i);
  }
  // Joints whose parent is placed come next, in document order.
  std::priority_queue<std::size_t, std::vector<std::size_t>, std::greater<>> next;
  for (const std::size_t i : outgoing[entity.reference_link]) next.push(i);
  std::vector<Joint> ordered;
  while (!next.empty()) {
    const std::size_t i = next.top();
    next.pop();
    ordered.push_back(entity.joints[i]);
    for (const std::size_t j : outgoing[entity.joints[i].child]) next.push(j);
  }
  if (!sound) return;  // what is not reached may only follow from that
  if (ordered.size() + 1 < entity.links.size()) return report_unreached(report, entity, incoming);
  entity.joints = std::move(ordered);
}

bool read_links(Draft& draft, Element& element, Entity& entity) {
  auto links = element.required_child("links");
  if (!links) return false;
  constexpr std::string_view known[] = {"link"};
  Ids ids;
  bool distinct = true;
  for (Element& link : links->children()) {
    if (link.name() == "link") {
      entity.links.push_back(read_link(draft, link, ids, distinct));
    } else {
      link.unknown_in("links", known);
    }
  }
  if (entity.links.empty()) links->fault("has no link; write at least one <link …>", {"link"});
  for (std::size_t i = 0; i < entity.links.size(); ++i) {
    draft.anchors.emplace(entity.links[i].id, i);
  }
  const auto reference = read_link_name(*links, "ref", draft);
  links->done();
  if (reference) entity.reference_link = *reference;
  for (std::size_t i = 0; i < entity.links.size(); ++i) {
    Link& link = entity.links[i];
    const bool is_reference = i == entity.reference_link;
    if (is_reference && link.mass > heaviest_mass) stay(draft.report, link.where, entity, link);
    const bool welded = !entity.movable && is_reference;
    if (welded || (link.mass > 0 && link.mass <= heaviest_mass)) continue;
    draft.report.fault(
        link.where,
        fmt::format("mass of link {} is {}", in_quotes(link.id),
                    link.mass > 0 ? "above 1e9 kg, the largest of a body that moves; what shall "
                                    "stay is the reference link of a movable=\"false\" prototype"
                                  : "0; write more than 0 kg"));
  }
  return reference.has_value() && distinct;
}

void read_joints(Draft& draft, Element& element, Entity& entity, bool rooted) {
  bool complete = rooted;
  if (auto joints = element.child("joints")) {
    constexpr std::string_view known[] = {"joint"};
    Ids ids;
    for (Element& joint : joints->children()) {
      if (joint.name() != "joint") {
        joint.unknown_in("joints", known);
      } else if (auto read = read_joint(draft, joint, ids)) {
        entity.joints.push_back(std::move(*read));
      } else {
        complete = false;
        draft.report.left_out("joint");
      }
    }
    joints->done();
  }
  if (complete) order_joints(draft.report, entity);
}

}  // namespace ziggurat::scene
