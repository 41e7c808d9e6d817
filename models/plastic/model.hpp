/// Models `similarity`, `semimech` and `hardening`.
#pragma once

#include "plastic/law.hpp"
#include "system/model.hpp"

namespace monograin::plastic {

[[nodiscard]] Model similarity_model() noexcept;
[[nodiscard]] Model semimech_model() noexcept;
[[nodiscard]] Model hardening_model() noexcept;

// The law of a scenario of each of them. @throws std::invalid_argument for a material that it has no law for
[[nodiscard]] Law similarity_law(const ModelInput& input);
[[nodiscard]] Law semimech_law(const ModelInput& input);
[[nodiscard]] Law hardening_law(const ModelInput& input);

}  // namespace monograin::plastic
