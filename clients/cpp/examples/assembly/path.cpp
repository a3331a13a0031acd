// SPDX-License-Identifier: MIT
#include "path.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <limits>

namespace assembly {
namespace {

constexpr double cell = 0.04;  // [m]
constexpr int farthest = 45;   // cells from the start, in x and y
constexpr int width = 2 * farthest + 1;
constexpr int nowhere = -1;

struct Cell {
  int i = 0, j = 0;
};
constexpr std::array<Cell, 8> steps = {
    {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};

bool is_inside(Cell at) { return std::max(std::abs(at.i), std::abs(at.j)) <= farthest; }
int key_of(Cell at) { return (at.i + farthest) * width + at.j + farthest; }
Cell cell_of(int key) { return {key / width - farthest, key % width - farthest}; }

/// Cost of crossing a cell: 1, more near an obstacle, much more within its radius. No cell is
/// forbidden, so there is a way from any place.
double cost_at(const Point& at, std::span<const Obstacle> obstacles) {
  double cost = 1;
  for (const Obstacle& obstacle : obstacles) {
    const double dx = at.x - obstacle.x, dy = at.y - obstacle.y;
    const double square = dx * dx + dy * dy;
    if (square >= obstacle.soft * obstacle.soft) continue;
    const double distance = std::sqrt(square);
    if (distance < obstacle.hard) {
      cost = cost + 30 + 60 * (obstacle.hard - distance) / obstacle.hard;
    } else {
      cost = cost + 4 * (obstacle.soft - distance) / (obstacle.soft - obstacle.hard);
    }
  }
  return cost;
}

struct Entry {
  int key = 0;
  double value = 0;
};

/// A heap, the smallest value first. Not std::push_heap: of equal values the same one comes first
/// as in the Lua script.
void push(std::vector<Entry>& heap, Entry entry) {
  std::size_t i = heap.size() + 1;  // from 1
  heap.emplace_back();
  while (i > 1) {
    const std::size_t parent = i / 2;
    if (heap[parent - 1].value <= entry.value) break;
    heap[i - 1] = heap[parent - 1];
    i = parent;
  }
  heap[i - 1] = entry;
}

int pop(std::vector<Entry>& heap) {
  const int top = heap.front().key;
  const Entry last = heap.back();
  heap.pop_back();
  const std::size_t size = heap.size();
  if (size == 0) return top;
  std::size_t i = 1;
  for (;;) {
    std::size_t child = 2 * i;
    if (child > size) break;
    if (child < size && heap[child].value < heap[child - 1].value) ++child;
    if (heap[child - 1].value >= last.value) break;
    heap[i - 1] = heap[child - 1];
    i = child;
  }
  heap[i - 1] = last;
  return top;
}

/// Node of the search: the state of a cell.
struct Node {
  double cost = -1;                                        // below 0: not computed yet
  double value = std::numeric_limits<double>::infinity();  // of the way to it
  int before = nowhere;                                    // on that way
  bool closed = false;
};

double left_over(Cell at, Cell goal) {
  const double a = std::abs(at.i - goal.i), b = std::abs(at.j - goal.j);
  return std::max(a, b) + 0.414 * std::min(a, b);
}

/// Fills the nodes until the goal is reached.
void search(std::vector<Node>& nodes, const Point& from, Cell goal,
            std::span<const Obstacle> obstacles) {
  std::vector<Entry> heap;
  nodes[key_of({})].value = 0;
  push(heap, {key_of({}), left_over({}, goal)});
  while (!heap.empty()) {
    const int key = pop(heap);
    if (key == key_of(goal)) return;
    Node& node = nodes[key];
    if (node.closed) continue;
    node.closed = true;
    const Cell at = cell_of(key);
    for (const Cell step : steps) {
      const Cell next = {at.i + step.i, at.j + step.j};
      if (!is_inside(next) || nodes[key_of(next)].closed) continue;
      Node& other = nodes[key_of(next)];
      if (other.cost < 0) {
        other.cost = cost_at({from.x + next.i * cell, from.y + next.j * cell}, obstacles);
      }
      const double length = step.i != 0 && step.j != 0 ? 1.414 : 1;
      const double value = node.value + other.cost * length;
      if (value >= other.value) continue;
      other.value = value;
      other.before = key;
      push(heap, {key_of(next), value + left_over(next, goal)});
    }
  }
}

}  // namespace

std::optional<std::vector<Point>> find_path(const Point& from, const Point& to,
                                            std::span<const Obstacle> obstacles) {
  const double across = std::floor((to.x - from.x) / cell + 0.5);
  const double along = std::floor((to.y - from.y) / cell + 0.5);
  if (!(std::max(std::abs(across), std::abs(along)) <= farthest)) return std::nullopt;
  const Cell goal = {static_cast<int>(across), static_cast<int>(along)};
  std::vector<Node> nodes(std::size_t{width} * width);
  search(nodes, from, goal, obstacles);
  std::vector<Point> points = {to};
  for (int key = nodes[key_of(goal)].before; key != nowhere && key != key_of({});
       key = nodes[key].before) {
    const Cell at = cell_of(key);
    points.push_back({from.x + at.i * cell, from.y + at.j * cell});
  }
  std::ranges::reverse(points);
  return points;
}

}  // namespace assembly
