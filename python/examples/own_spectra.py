# SPDX-License-Identifier: Apache-2.0
"""Lights and filters of one's own, as dicts, files' columns or colour-science's spectral distributions."""

import numpy as np

import metamer

library = metamer.Library()
lamp = {400.0: 0.1, 450.0: 1.0, 500.0: 0.3, 560.0: 0.8, 620.0: 0.6, 700.0: 0.1}
gel = metamer.Spectrum(np.linspace(380, 780, 41), np.linspace(0.2, 0.9, 41), quantity="transmittance", name="gel")

recipe = metamer.Recipe(lamp, library.illuminant("3200 K"), filters_out=[(gel, 0.5), "Lee 204 Full C.T. Orange"], observer_in="CIE 2015 2")
transform = metamer.Transform(recipe)

colour = [0.2, 0.5, 0.3]
value, matrix = transform.linearise(colour)
reflectance = transform.reflectance(colour)
temperature, duv = metamer.correlated_colour_temperature(lamp)
print(f"{value} by {matrix}; the lamp has {temperature:.0f} K, Duv {duv:.4f}")
brightest = transform.wavelengths[reflectance.argmax()]
print(f"the colour's reflectance is greatest at {brightest:.0f} nm")
