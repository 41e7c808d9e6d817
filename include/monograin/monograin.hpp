/// Mechanics of a single particle under contact: scenarios, runs, curves.
#pragma once

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
