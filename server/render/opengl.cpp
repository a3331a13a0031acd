// SPDX-License-Identifier: MIT
#include "render/opengl.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <type_traits>

namespace ziggurat::render {
namespace {

constexpr const char* library_name = "libOSMesa.so.8";

/// Stays loaded: LLVM can't be unloaded safely.
void* load_library() {
  void* library = dlopen(library_name, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (!library) {
    throw RenderError(fmt::format("pictures need {}, of Debian's package libosmesa6: {}",
                                  library_name, dlerror()));
  }
  return library;
}

template <class Function>
void find(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  if (!function) throw RenderError(fmt::format("{} has no {}", library_name, name));
}

/// Functions of OpenGL by name.
class Finder {
 public:
  explicit Finder(void* library) { find(library, "OSMesaGetProcAddress", get_); }

  template <class Function>
  void operator()(const char* name, Function& function) const {
    function = reinterpret_cast<Function>(get_(name));
    if (!function) throw RenderError(fmt::format("{} has no {}", library_name, name));
  }

 private:
  decltype(&OSMesaGetProcAddress) get_ = nullptr;
};

void find_buffers(const Finder& find, OpenGl& gl) {
  find("glBindBufferBase", gl.bind_buffer_base);
  find("glBindFramebuffer", gl.bind_framebuffer);
  find("glBindTextureUnit", gl.bind_texture_unit);
  find("glBlitNamedFramebuffer", gl.blit_named_framebuffer);
  find("glCheckNamedFramebufferStatus", gl.check_named_framebuffer_status);
  find("glClearNamedFramebufferfv", gl.clear_named_framebuffer);
  find("glCreateBuffers", gl.create_buffers);
  find("glCreateFramebuffers", gl.create_framebuffers);
  find("glCreateRenderbuffers", gl.create_renderbuffers);
  find("glCreateTextures", gl.create_textures);
  find("glDeleteFramebuffers", gl.delete_framebuffers);
  find("glDeleteRenderbuffers", gl.delete_renderbuffers);
  find("glNamedBufferData", gl.named_buffer_data);
  find("glNamedFramebufferDrawBuffer", gl.named_framebuffer_draw_buffer);
  find("glNamedFramebufferRenderbuffer", gl.named_framebuffer_renderbuffer);
  find("glNamedFramebufferTexture", gl.named_framebuffer_texture);
  find("glNamedRenderbufferStorageMultisample", gl.named_renderbuffer_storage);
  find("glReadPixels", gl.read_pixels);
  find("glTextureParameteri", gl.texture_parameter);
  find("glTextureParameterfv", gl.texture_parameters);
  find("glTextureStorage2D", gl.texture_storage);
  find("glTextureSubImage2D", gl.texture_sub_image);
}

void find_programs(const Finder& find, OpenGl& gl) {
  find("glAttachShader", gl.attach_shader);
  find("glCompileShader", gl.compile_shader);
  find("glCreateProgram", gl.create_program);
  find("glCreateShader", gl.create_shader);
  find("glGetProgramInfoLog", gl.get_program_info_log);
  find("glGetProgramiv", gl.get_program);
  find("glLinkProgram", gl.link_program);
  find("glShaderSource", gl.shader_source);
  find("glUseProgram", gl.use_program);
}

void find_drawing(const Finder& find, OpenGl& gl) {
  find("glBindVertexArray", gl.bind_vertex_array);
  find("glClipControl", gl.clip_control);
  find("glCreateVertexArrays", gl.create_vertex_arrays);
  find("glDepthFunc", gl.depth_func);
  find("glDisable", gl.disable);
  find("glDrawArrays", gl.draw_arrays);
  find("glDrawArraysInstanced", gl.draw_arrays_instanced);
  find("glDrawElementsInstancedBaseVertexBaseInstance", gl.draw_elements);
  find("glEnable", gl.enable);
  find("glEnableVertexArrayAttrib", gl.enable_vertex_array_attrib);
  find("glFrontFace", gl.front_face);
  find("glGetError", gl.get_error);
  find("glPolygonOffset", gl.polygon_offset);
  find("glVertexArrayAttribBinding", gl.vertex_array_attrib_binding);
  find("glVertexArrayAttribFormat", gl.vertex_array_attrib_format);
  find("glVertexArrayAttribIFormat", gl.vertex_array_attrib_integer_format);
  find("glVertexArrayBindingDivisor", gl.vertex_array_binding_divisor);
  find("glVertexArrayElementBuffer", gl.vertex_array_element_buffer);
  find("glVertexArrayVertexBuffer", gl.vertex_array_vertex_buffer);
  find("glViewport", gl.viewport);
}

}  // namespace

Context::Context() {
  void* library = load_library();
  decltype(&OSMesaCreateContextAttribs) create = nullptr;
  find(library, "OSMesaCreateContextAttribs", create);
  find(library, "OSMesaDestroyContext", destroy_);
  find(library, "OSMesaMakeCurrent", make_current_);
  const Finder finder(library);
  find_buffers(finder, gl_);
  find_programs(finder, gl_);
  find_drawing(finder, gl_);
  const int wanted[] = {OSMESA_FORMAT,
                        OSMESA_RGBA,
                        OSMESA_PROFILE,
                        OSMESA_CORE_PROFILE,
                        OSMESA_CONTEXT_MAJOR_VERSION,
                        4,
                        OSMESA_CONTEXT_MINOR_VERSION,
                        5,
                        0};
  context_ = create(wanted, nullptr);
  if (!context_) {
    throw RenderError(fmt::format("{} gives no context of OpenGL 4.5", library_name));
  }
  make_current();
}

Context::~Context() {
  if (context_) destroy_(context_);
}

void Context::make_current() {
  if (!make_current_(context_, unused_.data(), GL_UNSIGNED_BYTE, 4, 4)) {
    throw RenderError(fmt::format("{}: the context can't be made current", library_name));
  }
}

}  // namespace ziggurat::render
