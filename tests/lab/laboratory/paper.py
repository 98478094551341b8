"""What Wong et al. (2017) publish, to stand beside our figures."""

# Method, its name in the paper, average error, standard deviation, maximum (m), database (kB/m): Table 1.
TABLE_1 = {
    "wisurf": ("Comparative method 1", 3.71, 1.68, 4.61, 1.42),
    "scale-only": ("Comparative method 2", 1.00, 1.32, 11.04, 191.23),
    "tracklet-matching": ("Comparative method 3", 0.61, 0.46, 2.66, 80.96),
    "tracklet-regression": ("Proposed method 1", 0.42, 0.49, 2.92, 40.19),
    "tracklet-regression-kalman": ("Proposed method 2", 0.33, 0.27, 1.82, 40.19),
}

# Road type, method: average error, standard deviation, maximum (m): Table 2.
TABLE_2 = {
    ("curved", "tracklet-regression"): (0.39, 0.44, 2.58),
    ("curved", "tracklet-regression-particle"): (0.38, 0.36, 1.80),
    ("curved", "tracklet-regression-kalman"): (0.35, 0.31, 1.82),
    ("straight", "tracklet-regression"): (0.44, 0.54, 2.92),
    ("straight", "tracklet-regression-particle"): (0.32, 0.23, 0.88),
    ("straight", "tracklet-regression-kalman"): (0.31, 0.23, 0.96),
}

# The paper's order in Table 1, from the greatest average error to the least.
ORDER = tuple(TABLE_1)
ESTIMATORS = ("tracklet-regression", "tracklet-regression-particle", "tracklet-regression-kalman")
OURS = "milepost"
UNAVERAGED = "tracklet-regression-unaveraged"
ROAD_TYPES = ("curved", "straight")
