// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ofxImageEffect.h>

// Of OpenFX 1.5's ofxGPURender.h, where the headers at hand lack them. Its prose of ...OpenCLEnabled has 0 and 1 the
// wrong way round: hosts, and the header's own text about rendering, take 1 for "on".
#ifndef kOfxImageEffectPropCPURenderSupported
#define kOfxImageEffectPropCPURenderSupported "OfxImageEffectPropCPURenderSupported"
#endif
#ifndef kOfxImageEffectPropOpenCLRenderSupported
#define kOfxImageEffectPropOpenCLRenderSupported "OfxImageEffectPropOpenCLRenderSupported"
#endif
#ifndef kOfxImageEffectPropOpenCLEnabled
#define kOfxImageEffectPropOpenCLEnabled "OfxImageEffectPropOpenCLEnabled"
#endif
#ifndef kOfxImageEffectPropOpenCLCommandQueue
#define kOfxImageEffectPropOpenCLCommandQueue "OfxImageEffectPropOpenCLCommandQueue"
#endif
#ifndef kOfxImageEffectPropCudaRenderSupported
#define kOfxImageEffectPropCudaRenderSupported "OfxImageEffectPropCudaRenderSupported"
#endif
#ifndef kOfxImageEffectPropCudaEnabled
#define kOfxImageEffectPropCudaEnabled "OfxImageEffectPropCudaEnabled"
#endif
#ifndef kOfxImageEffectPropCudaStreamSupported
#define kOfxImageEffectPropCudaStreamSupported "OfxImageEffectPropCudaStreamSupported"
#endif
#ifndef kOfxImageEffectPropCudaStream
#define kOfxImageEffectPropCudaStream "OfxImageEffectPropCudaStream"
#endif
#ifndef kOfxImageEffectPropMetalRenderSupported
#define kOfxImageEffectPropMetalRenderSupported "OfxImageEffectPropMetalRenderSupported"
#endif
#ifndef kOfxImageEffectPropMetalEnabled
#define kOfxImageEffectPropMetalEnabled "OfxImageEffectPropMetalEnabled"
#endif
#ifndef kOfxImageEffectPropMetalCommandQueue
#define kOfxImageEffectPropMetalCommandQueue "OfxImageEffectPropMetalCommandQueue"
#endif
#ifndef kOfxStatGPURenderFailed
#define kOfxStatGPURenderFailed ((int)1002)
#endif
