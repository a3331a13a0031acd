// SPDX-License-Identifier: MIT
#include "render/renderer.h"

#include "render/canvas.h"
#include "render/drawing.h"
#include "render/labels.h"
#include "render/model.h"

namespace ziggurat::render {

struct Renderer::Parts {
  Parts(Model model, const world::Layout& layout) : draftsman(std::move(model), layout) {}

  Draftsman draftsman;
  Drawing drawing;
  Canvas canvas;
};

Renderer::Renderer(const scene::Scene& scene, const std::vector<scene::Entity>& entities,
                   const world::Layout& layout)
    : parts_(std::make_unique<Parts>(make_model(scene, entities), layout)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;

void Renderer::add(const scene::Entity& entity, std::size_t first_link) {
  parts_->draftsman.add(entity, first_link);
}

void Renderer::draw(const world::State& state, const View& view, Picture& picture) {
  Parts& p = *parts_;
  p.draftsman.draw(state, view, p.drawing);
  p.canvas.draw(p.drawing, p.draftsman.meshes(), p.draftsman.model(), view, picture);
  draw_labels(p.drawing.labels, picture);
}

}  // namespace ziggurat::render
