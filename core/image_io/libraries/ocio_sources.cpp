#include "core/image_io/libraries/ocio_sources.h"

#include <filesystem>

namespace OCIO = OCIO_NAMESPACE;

namespace terrazzo {

namespace {

class SourceFinder {
 public:
  explicit SourceFinder(const OCIO::Config& config) : config_(config), context_(config.getCurrentContext()) {}

  ColorSources find() {
    find_folders();
    for (int i = 0; i < config_.getNumColorSpaces(OCIO::SEARCH_REFERENCE_SPACE_ALL, OCIO::COLORSPACE_ALL); i++) {
      const char* name = config_.getColorSpaceNameByIndex(OCIO::SEARCH_REFERENCE_SPACE_ALL, OCIO::COLORSPACE_ALL, i);
      const OCIO::ConstColorSpaceRcPtr space = config_.getColorSpace(name);
      add(space->getTransform(OCIO::COLORSPACE_DIR_TO_REFERENCE));
      add(space->getTransform(OCIO::COLORSPACE_DIR_FROM_REFERENCE));
    }
    for (int i = 0; i < config_.getNumNamedTransforms(OCIO::NAMEDTRANSFORM_ALL); i++) {
      const char* name = config_.getNamedTransformNameByIndex(OCIO::NAMEDTRANSFORM_ALL, i);
      const OCIO::ConstNamedTransformRcPtr named = config_.getNamedTransform(name);
      add(named->getTransform(OCIO::TRANSFORM_DIR_FORWARD));
      add(named->getTransform(OCIO::TRANSFORM_DIR_INVERSE));
    }
    for (int i = 0; i < config_.getNumLooks(); i++) {
      const OCIO::ConstLookRcPtr look = config_.getLook(config_.getLookNameByIndex(i));
      add(look->getProcessSpace());
      add(look->getTransform());
      add(look->getInverseTransform());
    }
    for (int i = 0; i < config_.getNumViewTransforms(); i++) {
      const OCIO::ConstViewTransformRcPtr view = config_.getViewTransform(config_.getViewTransformNameByIndex(i));
      add(view->getTransform(OCIO::VIEWTRANSFORM_DIR_TO_REFERENCE));
      add(view->getTransform(OCIO::VIEWTRANSFORM_DIR_FROM_REFERENCE));
    }
    find_views();
    return std::move(out_);
  }

 private:
  std::string add(const char* text) { return expand(*context_, text, out_.variables); }

  /// Folders in the library's form: without surrounding spaces and trailing slashes.
  void find_folders() {
    const std::filesystem::path beside = context_->getWorkingDir();
    for (int i = 0; i < context_->getNumSearchPaths(); i++) {
      std::string folder = add(context_->getSearchPath(i));
      folder.erase(0, std::min(folder.find_first_not_of(" \t\r\n"), folder.size()));
      folder.erase(folder.find_last_not_of(" \t\r\n") + 1);
      folder.erase(folder.find_last_not_of('/') + 1);
      out_.folders.push_back((beside / folder).lexically_normal().string());
    }
    if (out_.folders.empty()) out_.folders.push_back(beside.string());
  }

  /// Transforms can go through the views of displays.
  void find_views() {
    for (int d = 0; d < config_.getNumDisplaysAll(); d++) {
      const char* display = config_.getDisplayAll(d);
      for (const OCIO::ViewType type : {OCIO::VIEW_SHARED, OCIO::VIEW_DISPLAY_DEFINED})
        for (int v = 0; v < config_.getNumViews(type, display); v++) {
          const char* view = config_.getView(type, display, v);
          add(config_.getDisplayViewColorSpaceName(display, view));
          add(config_.getDisplayViewLooks(display, view));
        }
    }
  }

  void add(const OCIO::ConstTransformRcPtr& transform) {
    if (const auto group = OCIO::DynamicPtrCast<const OCIO::GroupTransform>(transform)) {
      for (int i = 0; i < group->getNumTransforms(); i++) add(group->getTransform(i));
    } else if (const auto file = OCIO::DynamicPtrCast<const OCIO::FileTransform>(transform)) {
      out_.files.push_back(add(file->getSrc()));
      add(file->getCCCId());
    } else if (const auto space = OCIO::DynamicPtrCast<const OCIO::ColorSpaceTransform>(transform)) {
      add(space->getSrc());
      add(space->getDst());
    } else if (const auto look = OCIO::DynamicPtrCast<const OCIO::LookTransform>(transform)) {
      add(look->getSrc());
      add(look->getDst());
      add(look->getLooks());
    } else if (const auto view = OCIO::DynamicPtrCast<const OCIO::DisplayViewTransform>(transform)) {
      add(view->getSrc());
      add(view->getDisplay());
      add(view->getView());
    }
  }

  const OCIO::Config& config_;
  OCIO::ConstContextRcPtr context_;
  ColorSources out_;
};

}  // namespace

ColorSources sources_of(const OCIO::Config& config) {
  return SourceFinder(config).find();
}

std::string expand(const OCIO::Context& context, const char* text, std::map<std::string, std::string>& variables) {
  OCIO::ContextRcPtr used = OCIO::Context::Create();
  std::string out = context.resolveStringVar(text, used);
  for (int i = 0; i < used->getNumStringVars(); i++)
    variables.insert_or_assign(used->getStringVarNameByIndex(i), used->getStringVarByIndex(i));
  return out;
}

}  // namespace terrazzo
