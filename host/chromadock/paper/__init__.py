"""The published detector, step by step as printed: the reference for later methods.

Knutson, Cao, Sattar, "Adaptive Landmark Color for AUV Docking in Visually Dynamic
Environments" (ICRA 2024), section III.D.  Where the text leaves a number open, it
stands in these modules with its reason; ``docs/method.md`` lists them.
"""
