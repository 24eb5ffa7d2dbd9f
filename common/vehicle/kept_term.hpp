// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/vehicle/effect_file.hpp"

namespace tread {

/// An unnamed term as an effect of the name, with `share` of the term's values as its size.
EffectEntry effectOf(const UnnamedTerm& term, const std::string& name);

/// Replaces an unnamed term of a model by the effect of this name, which effectOf() made from it
/// and which is in the catalogue. The uncertainty of its values becomes that of its share.
void replaceTerm(ModelDocument& document, const std::string& term, const Effect& effect);

}  // namespace tread
