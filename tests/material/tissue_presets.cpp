// Tissue presets and unit factors.
#include <palpate/material/tissue_presets.hpp>

#include <set>

#include "catch.hpp"

using namespace palpate;

TEST_CASE("every preset is a valid material with a source and a unique name", "[material][presets]") {
  std::set<std::string_view> names;
  for (const TissuePreset& preset : tissue_presets) {
    INFO(preset.name);
    CHECK(!preset.material().check());
    CHECK(preset.material().youngs_modulus == preset.youngs_modulus);
    CHECK(preset.material(0.3).poisson_ratio == 0.3);
    CHECK(preset.youngs_modulus > 1e3);  // Pa, not kPa
    CHECK(preset.youngs_modulus < 1e6);
    CHECK(preset.density > 800.0);
    CHECK(preset.density < 1300.0);
    CHECK(preset.deviation >= 0.0);
    CHECK(preset.deviation < preset.youngs_modulus);
    CHECK(!preset.source.empty());
    CHECK(!preset.measured.empty());
    CHECK(!preset.density_from.empty());
    CHECK(names.insert(preset.name).second);
    CHECK(&tissue_preset(preset.name) == &preset);
  }
}

TEST_CASE("shear moduli of the sources are converted to Young's moduli", "[material][presets]") {
  CHECK_THAT(tissue_preset("liver").youngs_modulus, Catch::Matchers::WithinRel(2.0 * 1.49 * 1800.0, 1e-12));
  CHECK_THAT(tissue_preset("liver").material().shear_modulus(), Catch::Matchers::WithinRel(1800.0, 1e-12));
}

TEST_CASE("an unknown preset is refused with a list of the names", "[material][presets]") {
  try {
    tissue_preset("brain");
    FAIL("accepted");
  } catch (const SetupError& error) {
    CHECK(error.kind() == SetupErrorKind::bad_argument);
    CHECK(std::string(error.what()).find("'liver'") != std::string::npos);
  }
}

TEST_CASE("unit factors", "[core][units]") {
  CHECK(5.4 * units::kPa == 5400.0);
  CHECK(2.0 * units::mm == 0.002);
  CHECK(1.06 * units::g_per_cm3 == 1060.0);
  CHECK(0.5 * units::N_per_mm == 500.0);
}
