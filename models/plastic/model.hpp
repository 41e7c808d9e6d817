/// Models `similarity`, `semimech` and `hardening`.
#pragma once

#include "plastic/law.hpp"
#include "system/model.hpp"

namespace monograin::plastic {

[[nodiscard]] Model similarity_model() noexcept;
[[nodiscard]] Model semimech_model() noexcept;
[[nodiscard]] Model hardening_model() noexcept;

// Laws of these models for a scenario. @throws std::invalid_argument for a material without a law
[[nodiscard]] Law similarity_law(const ModelInput& input);
[[nodiscard]] Law semimech_law(const ModelInput& input);
[[nodiscard]] Law hardening_law(const ModelInput& input);

}  // namespace monograin::plastic
