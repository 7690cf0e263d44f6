"""Writes the files of GSD in this folder, by gsd 5 and NumPy: python3 make_gsd.py FOLDER."""
import gsd.hoomd, numpy as np, sys
out=sys.argv[1]
def frame(step,N,box,pos,**k):
    f=gsd.hoomd.Frame(); f.configuration.step=step; f.configuration.dimensions=k.pop("dims",2); f.configuration.box=box
    f.particles.N=N; f.particles.position=pos
    for n,v in k.items():
        if n=="log": f.log=v
        else: setattr(f.particles,n,v)
    return f
P=np.array([[-2,1,0],[0,0,0],[1.5,-1,0]],dtype=np.float32)
with gsd.hoomd.open(out+"/hoomd_plain.gsd","w") as t:
    t.append(frame(0,3,[8,6,0,0,0,0],P,types=["A","B"],typeid=[0,1,0],diameter=[1,0.7,1],mass=[1,0.49,1],velocity=[[1,0,0],[0,2,0],[0,0,0]],image=[[1,0,0],[0,0,0],[-1,2,0]]))
    t.append(frame(100,3,[8,6,0,0,0,0],P+np.float32([0.25,0,0])))
    t.append(frame(200,2,[8,6,0,0,0,0],P[:2],diameter=[1,1]))
q=np.array([[np.cos(.15),0,0,np.sin(.15)]]*3)
I=np.array([[0,0,0.125]]*3); w=np.array([0.5,-1,0])
L=np.array([[-2*q[i,3]*I[i,2]*w[i]*1.0,0,0,2*q[i,0]*I[i,2]*w[i]] for i in range(3)])
with gsd.hoomd.open(out+"/hoomd_turning.gsd","w") as t:
    t.append(frame(7,3,[8,6,1,0,0,0],P,orientation=q,moment_inertia=I,angmom=L,diameter=[1,1,1]))
with gsd.hoomd.open(out+"/hoomd_shapes.gsd","w") as t:
    t.append(frame(0,3,[8,6,0,0,0,0],P,types=["A","B"],typeid=[0,1,0],type_shapes=[{"type":"Sphere","diameter":0.9},{"type":"Sphere","diameter":0.5}]))
with gsd.hoomd.open(out+"/hoomd_polygons.gsd","w") as t:
    t.append(frame(0,3,[8,6,0,0,0,0],P,types=["A"],typeid=[0,0,0],type_shapes=[{"type":"Polygon","vertices":[[0,0],[1,0],[0,1]]}]))
with gsd.hoomd.open(out+"/hoomd_tilted.gsd","w") as t:
    t.append(frame(0,3,[8,6,0,0.5,0,0],P))
with gsd.hoomd.open(out+"/hoomd_3d.gsd","w") as t:
    t.append(frame(0,3,[8,6,4,0,0,0],P+np.float32([[0,0,0],[0,0,1],[0,0,0]]),dims=3))
with gsd.hoomd.open(out+"/hoomd_plane_3d.gsd","w") as t:
    t.append(frame(0,3,[8,6,4,0,0,0],P+np.float32([0,0,1.5]),dims=3))
with gsd.hoomd.open(out+"/hoomd_diameters_missing.gsd","w") as t:
    t.append(frame(0,3,[8,6,0,0,0,0],P))
with gsd.hoomd.open(out+"/hoomd_overlap.gsd","w") as t:
    t.append(frame(0,3,[8,6,0,0,0,0],P,diameter=[1,1,3.5]))
with gsd.hoomd.open(out+"/hoomd_empty.gsd","w") as t:
    t.append(frame(0,0,[8,6,0,0,0,0],np.zeros((0,3))))
with gsd.hoomd.open(out+"/hoomd_none.gsd","w") as t: pass
import gsd.fl
def raw(name, chunks, version=[1,4]):
    with gsd.fl.open(out+f"/{name}.gsd","w",application="hand",schema="hoomd",schema_version=version) as t:
        for frame in chunks:
            for k,v in frame.items(): t.write_chunk(k,np.array(v[0],dtype=v[1]))
            t.end_frame()
base={"configuration/step":([3],"u8"),"configuration/dimensions":([2],"u1"),"configuration/box":([8,6,0,0,0,0],"f4"),"particles/N":([3],"u4"),
  "particles/position":(P,"f4"),"particles/typeid":([0,1,0],"u4")}
raw("hoomd_spheres",[{**base,"state/hpmc/sphere/radius":([0.4,0.3],"f4"),"state/hpmc/integrate/d":([0.1],"f8")}])
raw("hoomd_ellipsoids",[{**base,"state/hpmc/ellipsoid/a":([0.4,0.3],"f4")}])
raw("double",[{**base,"particles/position":(P+0.1,"f8"),"particles/diameter":([1,.5,1],"f8"),"particles/image":([[1,0,0],[0,-3,0],[0,0,0]],"i8")}])
raw("short",[{**base,"particles/diameter":([1,1],"f4")}])
raw("flat",[{**base,"particles/position":(P[:,:2],"f4")}])
raw("no_positions",[{k:v for k,v in base.items() if "pos" not in k}])
raw("bad_radius",[{**base,"particles/diameter":([1,0,1],"f4")}])
raw("bad_mass",[{**base,"particles/mass":([1,-1,1],"f4")}])
raw("outside",[{**base,"particles/position":(P+np.array([3,0,0]),"f4"),"log/periodic":([1,0],"u1")},{**base,"particles/position":(P+np.array([0,4,0]),"f4"),"log/periodic":([1,0],"u1")}])
raw("ids",[{**base,"log/particles/id":([5,2,9],"u8"),"log/time":([2.5],"f8"),"log/gravity":([[0,-1]],"f8"),"log/center":([[4,3]],"f8")}])
raw("doubled_ids",[{**base,"log/particles/id":([5,2,5],"u8")}])
raw("moving_out",[{**base,"particles/velocity":([[1,0,0],[0,0,1],[0,0,0]],"f4")}])
raw("types",[{**base,"particles/typeid":([0,70000,0],"u4")}])
raw("names",[{**base,"particles/types":([[65,0],[66,0]],"i1")}])
raw("unused",[{**base,"particles/angmom":([[0,0,0,1]]*3,"f4"),"particles/charge":([1,0,0],"f4"),"log/energy":([2.5],"f8")}])
for name,value in [("time",[np.nan]),("gravity",[[0,np.inf]]),("center",[[np.nan,3]]),("domain",[0,np.nan,0,6])]:
    raw("bad_"+name,[{**base,"log/"+name:(value,"f8")}])
with gsd.fl.open(out+"/other_schema.gsd","w",application="x",schema="other",schema_version=[1,0]) as t:
    t.write_chunk("a",np.zeros(3)); t.end_frame()
