// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Carries the precompiled headers of libraries and programs; it has nothing of its own.
