// Empty: the library astrolith_test_headers exists for its precompiled header.
