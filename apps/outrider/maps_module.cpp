#include "maps_module.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

namespace outrider::app {
namespace {

const MapsModule& load() {
  const auto file = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "outrider_maps.so";
  void* module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (module == nullptr) throw std::runtime_error(fmt::format("cannot load the maps module: {}", dlerror()));
  const auto get = reinterpret_cast<const MapsModule* (*)()>(dlsym(module, "outrider_maps_module"));
  if (get == nullptr) throw std::runtime_error(fmt::format("{}: is no maps module", file.string()));
  return *get();
}

}  // namespace

const MapsModule& maps_module() {
  static const MapsModule& module = load();
  return module;
}

}  // namespace outrider::app
