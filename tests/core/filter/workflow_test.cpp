#include "core/filter/workflow.h"

#include <doctest/doctest.h>

using namespace terrazzo;

namespace {

double difference(const Vector3d& a, const Vector3d& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("a pure metal has no diffuse colour, and reflects its base colour") {
  const Vector3d gold(1.0, 0.766, 0.336);
  const SpecularColors specular = to_specular({gold, 1});
  CHECK(difference(specular.diffuse, Vector3d(0, 0, 0)) < 1e-12);
  CHECK(difference(specular.specular, gold) < 1e-12);
  const MetallicColors metallic = to_metallic({Vector3d(0, 0, 0), gold});
  CHECK(metallic.metallic == doctest::Approx(1).epsilon(1e-9));
  CHECK(difference(metallic.base, gold) < 1e-9);
}

TEST_CASE("a pure dielectric reflects 0.04, and its base colour is its diffuse colour") {
  const Vector3d clay(0.5, 0.25, 0.1), f0(0.04, 0.04, 0.04);
  const SpecularColors specular = to_specular({clay, 0});
  CHECK(difference(specular.diffuse, clay) < 1e-12);
  CHECK(difference(specular.specular, f0) < 1e-12);
  const MetallicColors metallic = to_metallic({clay, f0});
  CHECK(metallic.metallic == 0);
  CHECK(difference(metallic.base, clay) < 1e-12);
}

TEST_CASE("a grey half metal, by hand") {
  // Base 0.5, half metallic: specular 0.02 + 0.25, diffuse 0.5 * 0.96 * 0.5 / (1 - 0.27).
  const SpecularColors specular = to_specular({Vector3d(0.5, 0.5, 0.5), 0.5});
  CHECK(specular.specular.x() == doctest::Approx(0.27));
  CHECK(specular.diffuse.x() == doctest::Approx(0.24 / 0.73));
  const MetallicColors back = to_metallic(specular);
  CHECK(back.metallic == doctest::Approx(0.5));
  CHECK(back.base.x() == doctest::Approx(0.5));
}

TEST_CASE("every colour and mixture brighter than a dielectric's reflection comes back") {
  double worst = 0;
  for (const double r : {0.0, 0.2, 0.6, 1.0})
    for (const double g : {0.1, 0.4, 0.9})
      for (const double b : {0.0, 0.5, 1.0})
        for (const double metallic : {0.0, 0.05, 0.3, 0.5, 0.8, 0.99, 1.0}) {
          const Vector3d base(r, g, b);
          const MetallicColors back = to_metallic(to_specular({base, metallic}));
          worst = std::max({worst, std::abs(back.metallic - metallic), difference(back.base, base)});
        }
  CHECK(worst < 1e-9);
}

TEST_CASE("a mirror reflects everything and leaves no diffuse light") {
  const MetallicColors metallic = to_metallic({Vector3d(1, 1, 1), Vector3d(1, 1, 1)});
  CHECK(metallic.metallic == doctest::Approx(1));
  CHECK(difference(metallic.base, Vector3d(1, 1, 1)) < 1e-9);
  const SpecularColors specular = to_specular({Vector3d(1, 1, 1), 1});
  CHECK(difference(specular.diffuse, Vector3d(0, 0, 0)) < 1e-9);
}

TEST_CASE("less than 0.04 is a dielectric") {
  CHECK(to_metallic({Vector3d(0.3, 0.3, 0.3), Vector3d(0.01, 0.02, 0.03)}).metallic == 0);
  CHECK(to_metallic({Vector3d(0, 0, 0), Vector3d(0, 0, 0)}).metallic == 0);
}
