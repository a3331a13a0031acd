// SPDX-License-Identifier: MIT
// Setup of a canvas: its programs, and the locations of their arrays.

#include <fmt/format.h>

#include <cstddef>
#include <string>

#include "render/canvas.h"
#include "render/shaders.h"

namespace ziggurat::render {
namespace {

GLuint make_shader(const OpenGl& gl, GLenum stage, const char* text) {
  const GLuint shader = gl.create_shader(stage);
  const char* parts[] = {shaders::common, text};
  gl.shader_source(shader, 2, parts, nullptr);
  gl.compile_shader(shader);
  return shader;
}

/// Errors of a shader are reported when it is linked.
GLuint make_program(const OpenGl& gl, const char* vertex, const char* fragment) {
  const GLuint program = gl.create_program();
  gl.attach_shader(program, make_shader(gl, GL_VERTEX_SHADER, vertex));
  gl.attach_shader(program, make_shader(gl, GL_FRAGMENT_SHADER, fragment));
  gl.link_program(program);
  GLint linked = GL_FALSE;
  gl.get_program(program, GL_LINK_STATUS, &linked);
  if (linked == GL_FALSE) {
    std::string text(4096, '\0');
    GLsizei length = 0;
    gl.get_program_info_log(program, static_cast<GLsizei>(text.size()), &length, text.data());
    text.resize(static_cast<std::size_t>(length));
    throw RenderError(fmt::format("OpenGL refuses a program: {}", text));
  }
  return program;
}

/// Attributes of a vertex array, each of three components.
class Attributes {
 public:
  Attributes(const OpenGl& gl, GLuint arrays) : gl_(gl), arrays_(arrays) {}

  /// The next buffer. @param divisor  0: an element per vertex; 1: per instance
  void buffer(GLuint buffer, std::size_t stride, GLuint divisor) {
    gl_.vertex_array_vertex_buffer(arrays_, next_binding_, buffer, 0, static_cast<GLsizei>(stride));
    gl_.vertex_array_binding_divisor(arrays_, next_binding_, divisor);
    ++next_binding_;
  }
  void floats(GLuint location, std::size_t offset) {
    gl_.vertex_array_attrib_format(arrays_, location, 3, GL_FLOAT, GL_FALSE,
                                   static_cast<GLuint>(offset));
    enable(location);
  }
  void integers(GLuint location, std::size_t offset) {
    gl_.vertex_array_attrib_integer_format(arrays_, location, 3, GL_UNSIGNED_INT,
                                           static_cast<GLuint>(offset));
    enable(location);
  }

 private:
  void enable(GLuint location) {
    gl_.vertex_array_attrib_binding(arrays_, location, next_binding_ - 1);
    gl_.enable_vertex_array_attrib(arrays_, location);
  }

  const OpenGl& gl_;
  GLuint arrays_;
  GLuint next_binding_ = 0;
};

}  // namespace

void Canvas::make_programs() {
  const OpenGl& gl = context_.gl();
  body_program_ = make_program(gl, shaders::body_vertex, shaders::body_fragment);
  shadow_program_ = make_program(gl, shaders::shadow_vertex, shaders::shadow_fragment);
  floor_program_ = make_program(gl, shaders::floor_vertex, shaders::floor_fragment);
  sky_program_ = make_program(gl, shaders::sky_vertex, shaders::sky_fragment);
  line_program_ = make_program(gl, shaders::line_vertex, shaders::line_fragment);
  mark_program_ = make_program(gl, shaders::mark_vertex, shaders::mark_fragment);
}

void Canvas::take(const Meshes& meshes) {
  const OpenGl& gl = context_.gl();
  gl.named_buffer_data(mesh_buffers_[0],
                       static_cast<GLsizeiptr>(meshes.vertices.size() * sizeof(Vertex)),
                       meshes.vertices.data(), GL_STATIC_DRAW);
  gl.named_buffer_data(mesh_buffers_[1],
                       static_cast<GLsizeiptr>(meshes.indices.size() * sizeof(std::uint32_t)),
                       meshes.indices.data(), GL_STATIC_DRAW);
}

void Canvas::make_body_arrays() {
  const OpenGl& gl = context_.gl();
  gl.create_buffers(2, mesh_buffers_);
  gl.create_buffers(1, &body_instances_);
  gl.create_vertex_arrays(1, &body_arrays_);
  gl.vertex_array_element_buffer(body_arrays_, mesh_buffers_[1]);
  Attributes attributes(gl, body_arrays_);
  attributes.buffer(mesh_buffers_[0], sizeof(Vertex), 0);
  attributes.floats(0, offsetof(Vertex, position));
  attributes.floats(1, offsetof(Vertex, normal));
  attributes.floats(2, offsetof(Vertex, edge));
  attributes.buffer(body_instances_, sizeof(BodyInstance), 1);
  for (GLuint axis = 0; axis < 3; ++axis) {
    attributes.floats(3 + axis, offsetof(BodyInstance, axes) + axis * sizeof(Float3));
  }
  attributes.floats(6, offsetof(BodyInstance, position));
  attributes.floats(7, offsetof(BodyInstance, size));
  attributes.floats(8, offsetof(BodyInstance, color));
}

void Canvas::make_mark_arrays() {
  const OpenGl& gl = context_.gl();
  gl.create_buffers(1, &mark_instances_);
  gl.create_vertex_arrays(1, &mark_arrays_);
  Attributes attributes(gl, mark_arrays_);
  attributes.buffer(mark_instances_, sizeof(MarkInstance), 1);
  attributes.floats(0, offsetof(MarkInstance, center));
  attributes.floats(1, offsetof(MarkInstance, x));
  attributes.floats(2, offsetof(MarkInstance, y));
  attributes.floats(3, offsetof(MarkInstance, color));
  attributes.integers(4, offsetof(MarkInstance, code));
}

void Canvas::make_line_arrays() {
  const OpenGl& gl = context_.gl();
  gl.create_buffers(1, &line_instances_);
  gl.create_vertex_arrays(1, &line_arrays_);
  Attributes attributes(gl, line_arrays_);
  attributes.buffer(line_instances_, sizeof(LineInstance), 1);
  attributes.floats(0, offsetof(LineInstance, start));
  attributes.floats(1, offsetof(LineInstance, end));
  attributes.floats(2, offsetof(LineInstance, color));
}

}  // namespace ziggurat::render
