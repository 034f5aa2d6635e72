"""Many designs of a drive: batches, studies, sensitivity, optimisation, calibration."""
