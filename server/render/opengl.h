// SPDX-License-Identifier: MIT
#pragma once
// OpenGL 4.5 on the CPU, without a display: Mesa's OSMesa, loaded when the first context is made.
// Linking it would cost every start of the program the loading of LLVM.

// The headers' prototypes serve as types; none of them is called.
#define GL_GLEXT_PROTOTYPES
#include <GL/osmesa.h>
// osmesa.h includes gl.h, which the next one completes.
#include <GL/glext.h>

#include <array>
#include <cstdint>
#include <stdexcept>

namespace ziggurat::render {

/// OpenGL is missing or fails; the message says what to install.
class RenderError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// OpenGL's functions by their names, without the prefix.
struct OpenGl {
  decltype(&glAttachShader) attach_shader;
  decltype(&glBindBufferBase) bind_buffer_base;
  decltype(&glBindFramebuffer) bind_framebuffer;
  decltype(&glBindTextureUnit) bind_texture_unit;
  decltype(&glBindVertexArray) bind_vertex_array;
  decltype(&glBlitNamedFramebuffer) blit_named_framebuffer;
  decltype(&glCheckNamedFramebufferStatus) check_named_framebuffer_status;
  decltype(&glClearNamedFramebufferfv) clear_named_framebuffer;
  decltype(&glClipControl) clip_control;
  decltype(&glCompileShader) compile_shader;
  decltype(&glCreateBuffers) create_buffers;
  decltype(&glCreateFramebuffers) create_framebuffers;
  decltype(&glCreateProgram) create_program;
  decltype(&glCreateRenderbuffers) create_renderbuffers;
  decltype(&glCreateShader) create_shader;
  decltype(&glCreateTextures) create_textures;
  decltype(&glCreateVertexArrays) create_vertex_arrays;
  decltype(&glDeleteFramebuffers) delete_framebuffers;
  decltype(&glDeleteRenderbuffers) delete_renderbuffers;
  decltype(&glDepthFunc) depth_func;
  decltype(&glDisable) disable;
  decltype(&glDrawArrays) draw_arrays;
  decltype(&glDrawArraysInstanced) draw_arrays_instanced;
  decltype(&glDrawElementsInstancedBaseVertexBaseInstance) draw_elements;
  decltype(&glEnable) enable;
  decltype(&glEnableVertexArrayAttrib) enable_vertex_array_attrib;
  decltype(&glFrontFace) front_face;
  decltype(&glGetError) get_error;
  decltype(&glGetProgramInfoLog) get_program_info_log;
  decltype(&glGetProgramiv) get_program;
  decltype(&glLinkProgram) link_program;
  decltype(&glNamedBufferData) named_buffer_data;
  decltype(&glNamedFramebufferDrawBuffer) named_framebuffer_draw_buffer;
  decltype(&glNamedFramebufferRenderbuffer) named_framebuffer_renderbuffer;
  decltype(&glNamedFramebufferTexture) named_framebuffer_texture;
  decltype(&glNamedRenderbufferStorageMultisample) named_renderbuffer_storage;
  decltype(&glPolygonOffset) polygon_offset;
  decltype(&glReadPixels) read_pixels;
  decltype(&glShaderSource) shader_source;
  decltype(&glTextureParameteri) texture_parameter;
  decltype(&glTextureParameterfv) texture_parameters;
  decltype(&glTextureStorage2D) texture_storage;
  decltype(&glTextureSubImage2D) texture_sub_image;
  decltype(&glUseProgram) use_program;
  decltype(&glVertexArrayAttribBinding) vertex_array_attrib_binding;
  decltype(&glVertexArrayAttribFormat) vertex_array_attrib_format;
  decltype(&glVertexArrayAttribIFormat) vertex_array_attrib_integer_format;
  decltype(&glVertexArrayBindingDivisor) vertex_array_binding_divisor;
  decltype(&glVertexArrayElementBuffer) vertex_array_element_buffer;
  decltype(&glVertexArrayVertexBuffer) vertex_array_vertex_buffer;
  decltype(&glViewport) viewport;
};

/// A context of OpenGL; all objects that are made in it end with it.
class Context {
 public:
  Context();  ///< @throws RenderError
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Must be called before functions of gl(): another context may have become current.
  void make_current();
  const OpenGl& gl() const { return gl_; }

 private:
  decltype(&OSMesaDestroyContext) destroy_ = nullptr;
  decltype(&OSMesaMakeCurrent) make_current_ = nullptr;
  OSMesaContext context_ = nullptr;
  std::array<std::uint32_t, 16> unused_{};  // OSMesa needs a buffer to draw to
  OpenGl gl_{};
};

}  // namespace ziggurat::render
