// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Source of the tests' precompiled headers; otherwise empty.
