// SPDX-License-Identifier: MIT
#include "render/renderer.h"

#include <optional>

#include "render/canvas.h"
#include "render/drawing.h"
#include "render/labels.h"
#include "render/model.h"

namespace ziggurat::render {

struct Renderer::Parts {
  Parts(Model model, const world::Layout& layout) : draftsman(std::move(model), layout) {}

  Draftsman draftsman;
  Drawing drawing;
  std::optional<Canvas> canvas;
  std::size_t indices = 0;  // of the meshes that the canvas has
};

Renderer::Renderer(const scene::Scene& scene, const std::vector<scene::Entity>& entities,
                   const world::Layout& layout)
    : parts_(std::make_unique<Parts>(make_model(scene, entities), layout)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;

void Renderer::add(const scene::Entity& entity, std::size_t first_link) {
  parts_->draftsman.add(entity, first_link);
}

void Renderer::prepare() {
  Parts& p = *parts_;
  const Meshes& meshes = p.draftsman.meshes();
  if (!p.canvas) {
    p.canvas.emplace(meshes);
  } else if (p.indices != meshes.indices.size()) {
    p.canvas->take(meshes);
  }
  p.indices = meshes.indices.size();
}

void Renderer::draw(const world::State& state, const View& view, Picture& picture) {
  prepare();
  Parts& p = *parts_;
  p.draftsman.draw(state, view, p.drawing);
  p.canvas->draw(p.drawing, p.draftsman.model(), view, picture);
  draw_labels(p.drawing.labels, picture);
}

}  // namespace ziggurat::render
