#include <filesystem>
#include <mutex>
#include <sstream>

#include <OpenColorIO/OpenColorIO.h>

#include "core/base/error.h"
#include "core/image_io/libraries/ocio_sources.h"
#include "core/image_io/libraries/parts.h"

namespace OCIO = OCIO_NAMESPACE;

namespace terrazzo {

namespace {

OCIO::ColorSpaceRcPtr make_space(const char* name, const char* description) {
  OCIO::ColorSpaceRcPtr space = OCIO::ColorSpace::Create();
  space->setName(name);
  space->setDescription(description);
  space->setBitDepth(OCIO::BIT_DEPTH_F32);
  return space;
}

/// Reference: linear light, Rec.709 primaries.
OCIO::ConstConfigRcPtr built_in_config() {
  OCIO::ConfigRcPtr config = OCIO::Config::Create();
  config->setVersion(2, 0);
  config->addColorSpace(make_space("lin_rec709", "Linear light, Rec.709 primaries, D65"));

  OCIO::ColorSpaceRcPtr srgb = make_space("srgb_texture", "The sRGB transfer function, Rec.709 primaries, D65");
  OCIO::ExponentWithLinearTransformRcPtr curve = OCIO::ExponentWithLinearTransform::Create();
  curve->setGamma({2.4, 2.4, 2.4, 1.0});
  curve->setOffset({0.055, 0.055, 0.055, 0.0});
  curve->setNegativeStyle(OCIO::NEGATIVE_LINEAR);
  srgb->setTransform(curve, OCIO::COLORSPACE_DIR_TO_REFERENCE);
  config->addColorSpace(srgb);

  // AP1 (white point of ACES) to Rec.709 (D65) with the Bradford adaptation: SMPTE RP 177 applied to the primaries.
  OCIO::ColorSpaceRcPtr acescg = make_space("acescg", "Linear light, AP1 primaries, the white point of ACES");
  OCIO::MatrixTransformRcPtr matrix = OCIO::MatrixTransform::Create();
  const double to_rec709[16] = {1.70505099265815,
                                -0.621792120657,
                                -0.0832588720011,
                                0,  //
                                -0.130256417507,
                                1.14080473657,
                                -0.0105483190684,
                                0,  //
                                -0.0240033568046,
                                -0.128968976065,
                                1.15297233287,
                                0,  //
                                0,
                                0,
                                0,
                                1};
  matrix->setMatrix(to_rec709);
  acescg->setTransform(matrix, OCIO::COLORSPACE_DIR_TO_REFERENCE);
  config->addColorSpace(acescg);

  OCIO::ColorSpaceRcPtr raw = make_space("raw", "Values that are no colours; never converted");
  raw->setIsData(true);
  config->addColorSpace(raw);
  config->setRole(OCIO::ROLE_REFERENCE, "lin_rec709");
  config->setRole(OCIO::ROLE_SCENE_LINEAR, "lin_rec709");
  config->setRole(OCIO::ROLE_DATA, "raw");
  config->setRole(OCIO::ROLE_DEFAULT, "raw");
  return config;
}

void apply(const OCIO::ConstCPUProcessorRcPtr& processor, float* pixels, int channels, int64_t count) {
  OCIO::PackedImageDesc image(pixels, count, 1, 3, OCIO::BIT_DEPTH_F32, sizeof(float), channels * sizeof(float),
                              count * channels * sizeof(float));
  processor->apply(image);
}

/// Making a processor reads environment variables, for which the library (2.1) has one static string; and none may be
/// made while the library clears its file cache.
std::mutex& library_mutex() {
  static std::mutex mutex;
  return mutex;
}

template <typename Act>
auto with_library(const Act& act) {
  const std::lock_guard lock(library_mutex());
  try {
    return act();
  } catch (const OCIO::Exception& e) {
    throw Error(e.what());
  }
}

class OcioColors final : public ColorConfiguration {
 public:
  explicit OcioColors(OCIO::ConstConfigRcPtr config) : config_(std::move(config)) {}
  std::vector<std::string> names() const override {
    std::vector<std::string> names;
    for (int i = 0; i < config_->getNumColorSpaces(); i++) names.emplace_back(config_->getColorSpaceNameByIndex(i));
    return names;
  }
  std::string find(const std::string& name) const override {
    const OCIO::ConstColorSpaceRcPtr space = config_->getColorSpace(name.c_str());
    return space ? space->getName() : "";
  }
  Conversion conversion(const std::string& from, const std::string& to) const override {
    return with_library([&]() -> Conversion {
      // Lossless: approximations of pow would shift 16-bit values.
      const OCIO::ConstCPUProcessorRcPtr processor =
          config_->getProcessor(from.c_str(), to.c_str())->getOptimizedCPUProcessor(OCIO::OPTIMIZATION_LOSSLESS);
      return [processor](float* pixels, int channels, int64_t count) { apply(processor, pixels, channels, count); };
    });
  }
  std::vector<std::string> files_of(const std::string& from, const std::string& to) const override {
    return with_library([&] {
      const OCIO::ConstProcessorRcPtr processor = config_->getProcessor(from.c_str(), to.c_str());
      const OCIO::ConstProcessorMetadataRcPtr facts = processor->getProcessorMetadata();
      std::vector<std::string> files;
      for (int i = 0; i < facts->getNumFiles(); i++) files.emplace_back(facts->getFile(i));
      return files;
    });
  }
  ColorSources sources() const override {
    return with_library([&] { return sources_of(*config_); });
  }
  std::string expanded(const std::string& text, std::map<std::string, std::string>& variables) const override {
    return with_library([&] { return expand(*config_->getCurrentContext(), text.c_str(), variables); });
  }

 private:
  OCIO::ConstConfigRcPtr config_;
};

/// The library looks for files beside the configuration only if it has read the configuration itself.
OCIO::ConstConfigRcPtr config_in(const std::string& path, const std::string& text) {
  std::istringstream in(text);
  const OCIO::ConfigRcPtr config = OCIO::Config::CreateFromStream(in)->createEditableCopy();
  config->setWorkingDir(std::filesystem::absolute(path).lexically_normal().parent_path().c_str());
  return config;
}

}  // namespace

std::shared_ptr<const ColorConfiguration> load_with_ocio(const std::string& path, const std::string& text) {
  return with_library([&] {
    OCIO::ClearAllCaches();
    return std::make_shared<OcioColors>(path.empty() ? built_in_config() : config_in(path, text));
  });
}

}  // namespace terrazzo
