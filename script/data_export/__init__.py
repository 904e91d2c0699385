# SPDX-License-Identifier: Apache-2.0
"""The measured tables of data/, a module a group, from pinned registry packages."""
