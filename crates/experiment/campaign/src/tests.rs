//! Campaigns: see the files of each test.
