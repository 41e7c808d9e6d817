/// Mechanics of a single particle under contact: scenarios, runs, curves.
#pragma once

#if __cplusplus < 202002L
#error "monograin needs C++20; expected the option -std=c++20, or a later standard"
#endif
#ifdef _GLIBCXX_DEBUG
#error "monograin is compiled without _GLIBCXX_DEBUG, which changes containers; expected _GLIBCXX_ASSERTIONS or neither"
#endif

#include "monograin/comparison.hpp"
#include "monograin/continuum.hpp"
#include "monograin/faults.hpp"
#include "monograin/history.hpp"
#include "monograin/models.hpp"
#include "monograin/prepared.hpp"
#include "monograin/run.hpp"
#include "monograin/scenario.hpp"
#include "monograin/status.hpp"
#include "monograin/version.hpp"
